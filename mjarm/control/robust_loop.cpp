#include "mjarm/control/robust_loop.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/control.hpp"

namespace mjarm {
namespace {

constexpr int kMostLate = 20;
constexpr double kMostPhase = 0.5;  // [rad] that bandwidth and lateness may take together
constexpr double kJump = 0.05;      // [rad or m] no arm comes so far in a step: it was put there
// A joint moves where it has come this far [rad or m] within this time [s]: 3 steps of an encoder
// of 0.01 deg. What the observer says of friction is true once it forgot the time before.
constexpr double kMoved = 5e-4, kMovedWithin = 0.04;
constexpr double kForgotten = 8;  // time constants of the observer

Result<void> check_robust(const RobustOptions& options, double h) {
  const double phase = options.bandwidth * (options.late_steps + 1) * h;
  if (options.bandwidth > 0 && options.observer > 0 && options.friction_speed > 0 &&
      options.late_steps >= 0 && options.late_steps <= kMostLate && phase <= kMostPhase &&
      options.observer * h <= 1) {
    return {};
  }
  return fail(Errc::bad_input, text(msg::control_bad_robust, options.bandwidth, options.observer,
                                    options.late_steps, options.friction_speed, h));
}

}  // namespace

Result<RobustLoop> RobustLoop::create(const Model& model, const Arm& arm,
                                      const RobustOptions& options) {
  if (const auto usable = check_robust(options, model.timestep()); !usable) {
    return fail(usable.error());
  }
  return RobustLoop(model, arm, options);
}

RobustLoop::RobustLoop(const Model& model, const Arm& arm, const RobustOptions& options)
    : arm_(arm),
      options_(options),
      inverse_(model, arm),
      h_(model.timestep()),
      load_(JointVec::Zero(arm.dof())),
      friction_(load_),
      s_(load_),
      s_lag_{load_, load_, load_},
      s_next_(load_),
      moving_(static_cast<std::size_t>(arm.dof()), 0.0) {
  // Critically damped (E. Brookner, Tracking and Kalman Filtering Made Easy, 1998, ch. 1.2.10).
  const double pole = std::exp(-options.observer * h_), rest = 1 - pole;
  gain_q_ = 1 - pole * pole * pole;
  gain_v_ = 1.5 * rest * rest * (1 + pole) / h_;
  gain_load_ = rest * rest * rest / (h_ * h_);
  for (const double torque : arm.limits.torque) split_.emplace_back(torque);
}

JointVec RobustLoop::friction() const { return friction_; }

void RobustLoop::learn_from(const RobustLoop& other) {
  split_ = other.split_;
  friction_ = other.friction_;
  load_ = other.load_;
}

JointVec RobustLoop::directions(const JointVec& v) const {
  JointVec s(v.size());
  for (Eigen::Index i = 0; i < v.size(); ++i) s[i] = std::tanh(v[i] / options_.friction_speed);
  return s;
}

void RobustLoop::put(const JointVec& q, const JointVec& v) {
  for (int i = 0; i < arm_.dof(); ++i) {
    qpos_[static_cast<std::size_t>(arm_.joints[i].qpos)] = q[i];
    qvel_[static_cast<std::size_t>(arm_.joints[i].dof)] = v[i];
  }
}

void RobustLoop::begin(std::span<const double> qpos, const JointVec& q) {
  const JointVec zero = JointVec::Zero(arm_.dof());
  const bool jumped = runs_;
  q_ = q;
  v_ = zero;
  if (jumped) load_ = zero;  // it was of another posture
  pending_.clear();
  seen_.clear();
  std::ranges::fill(moving_, 0.0);
  for (JointVec& s : s_lag_) s = zero;
  const JointVec holding = inverse_.holding_torque(qpos) - load_;
  for (int i = 0; i <= options_.late_steps; ++i) pending_.push_back({holding, zero});
  runs_ = true;
}

RobustLoop::Motion RobustLoop::motion_at(const JointVec& q, const JointVec& v) {
  put(q, v);
  Motion motion{inverse_.mass_matrix(qpos_),
                inverse_.torque(qpos_, qvel_, JointVec::Zero(arm_.dof()))};
  motion.mass.diagonal() += inverse_.implicit_mass();
  return motion;
}

JointVec RobustLoop::torque(std::span<const double> qpos, std::span<const double> qvel,
                            const StepReference& reference) {
  const JointVec q = arm_positions(arm_, qpos);
  qpos_.assign(qpos.begin(), qpos.end());
  qvel_.assign(qvel.begin(), qvel.end());
  if (!runs_ || (q - q_).cwiseAbs().maxCoeff() > kJump) begin(qpos, q);
  const Motion motion = motion_at(q_, v_);
  observe(q, motion);
  learn(q);

  // Where the arm will be once this command acts.
  JointVec q_then = q_, v_then = v_;
  for (const Pending& one : pending_) {
    const JointVec driving = one.torque - motion.rest - friction_.cwiseProduct(one.s) + load_;
    v_then += h_ * JointVec(solve_symmetric(motion.mass, driving));
    q_then += h_ * v_then;
  }
  const double w = options_.bandwidth;
  const JointVec v_ref = reference.velocity(h_);
  const JointVec a =
      reference.acceleration(h_) + 2 * w * (v_ref - v_then) + w * w * (reference.now - q_then);
  s_next_ = directions(v_ref);
  put(q_then, v_then);
  return inverse_.torque(qpos_, qvel_, a) + friction_.cwiseProduct(s_next_) - load_;
}

void RobustLoop::take(const JointVec& torque) { pending_.push_back({torque, s_next_}); }

void RobustLoop::observe(const JointVec& q, const Motion& motion) {
  const Pending done = std::move(pending_.front());
  pending_.pop_front();
  s_ = done.s;
  const JointVec driving = done.torque - motion.rest - friction_.cwiseProduct(s_) + load_;
  v_ += h_ * JointVec(solve_symmetric(motion.mass, driving));
  q_ += h_ * v_;
  const JointVec off = q - q_;
  q_ += gain_q_ * off;
  v_ += gain_v_ * off;
  load_ += motion.mass * (gain_load_ * off);
}

void RobustLoop::learn(const JointVec& q) {
  const double share = 1 - std::exp(-options_.observer * h_);
  const JointVec* from = &s_;
  for (JointVec& s : s_lag_) {
    s += share * (*from - s);
    from = &s;
  }
  seen_.push_back(q);
  if (static_cast<double>(seen_.size() - 1) * h_ > kMovedWithin) seen_.pop_front();
  for (int i = 0; i < arm_.dof(); ++i) {
    FrictionSplit& split = split_[static_cast<std::size_t>(i)];
    double& moving = moving_[static_cast<std::size_t>(i)];
    split.drift(h_);
    moving = (q[i] - seen_.front()[i]) * s_[i] > kMoved ? moving + h_ : 0;
    if (moving < kForgotten / options_.observer) continue;
    const double s = s_lag_[2][i];
    const double more = split.measure(load_[i] - friction_[i] * s, s, h_);
    friction_[i] += more;
    load_[i] += more * s;
  }
}

}  // namespace mjarm
