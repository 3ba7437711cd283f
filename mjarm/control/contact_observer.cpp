#include "mjarm/control/contact_observer.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/control.hpp"

namespace mjarm {
namespace {

constexpr int kLatest = 20;            // [steps]
constexpr double kContactJump = 0.05;  // [rad or m] no arm comes so far in a step: it was put there
constexpr double kDrift = 0.005;       // of the largest torque, after a second
constexpr double kRubs = 1e-3;         // the same of the friction
constexpr double kForgets = 0.02;      // of a link error, in its standard deviation
constexpr double kSolverStep = 1e-7;   // [rad or m] what a simulation rounds where encoders do not
constexpr double kMostTorque = 1;      // of the largest torque: prior deviation of a contact's
// Friction of a joint whose direction nobody knows: its deviation, in the joint's own when it moves
// (more than one, as it may turn in a step), and what is left of it after a step.
constexpr double kStanding = 2.5, kKept = 0.75;
constexpr std::size_t kShortLook = 5, kLongLook = 20;  // [steps] in which a joint has moved

/// For so many steps of time an encoder is off by about the same amount: while a joint takes
/// several for one step of its encoder, and where it goes nearly a whole number of them in each.
/// @param pace, change  steps of the encoder in a step of time, and by how much that changes.
double rounded_alike(double pace, double change) {
  const double off = std::abs(pace - std::round(pace));
  const double steps =
      pace < 0.5 ? 1 / std::max(off, 1e-12) : 1 / (off + std::sqrt(off * off + change));
  return std::clamp(steps, 1.0, 20.0);
}

/// F X, F = [1 h hG; 0 1 G; 0 0 1]: how positions, velocities and unknowns go on. G is (dof,
/// unknowns).
void carry(Eigen::MatrixXd& X, const Eigen::MatrixXd& G, double h) {
  const Eigen::Index n = G.rows();
  X.middleRows(n, n).noalias() += G * X.bottomRows(G.cols());
  X.topRows(n) += h * X.middleRows(n, n);
}

/// Torques of this step with that variance (dof,), independent of each other.
void add_torque_noise(Eigen::MatrixXd& P, const Eigen::MatrixXd& inverse_mass,
                      const Eigen::VectorXd& variance, double h) {
  const Eigen::Index n = variance.size();
  const Eigen::MatrixXd Q = h * h * inverse_mass * variance.asDiagonal() * inverse_mass;
  P.topLeftCorner(n, n) += h * h * Q;
  P.block(0, n, n, n) += h * Q;
  P.block(n, 0, n, n) += h * Q;
  P.block(n, n, n, n) += Q;
}

}  // namespace

Result<ContactObserver> ContactObserver::create(const Model& model, const Arm& arm,
                                                const ContactOptions& options) {
  const ModelErrors& errors = options.errors;
  const bool usable = options.late_steps >= 0 && options.late_steps <= kLatest &&
                      options.encoder_step >= 0 && options.torque_noise >= 0 && errors.mass >= 0 &&
                      errors.mass < 1 && errors.center >= 0 && errors.friction >= 0 &&
                      options.surprise > 0 &&
                      std::isfinite(options.encoder_step + options.torque_noise + errors.center +
                                    errors.friction + options.surprise);
  if (!usable) {
    return fail(Errc::bad_input, text(msg::control_bad_contact, options.late_steps,
                                      options.encoder_step, options.torque_noise, errors.mass,
                                      errors.center, errors.friction, options.surprise));
  }
  return ContactObserver(model, arm, options);
}

ContactObserver::ContactObserver(const Model& model, const Arm& arm, const ContactOptions& options)
    : arm_(arm),
      options_(options),
      inverse_(model, arm),
      errors_(model, arm, options.errors),
      h_(model.timestep()),
      joints_(arm.dof()),
      unknown_(errors_.count() + 3 * arm.dof()),
      prior_((kMostTorque * arm.limits.torque).cwiseAbs2().cwiseInverse()) {}

/// [N m or N] One standard deviation above what is known.
JointVec ContactObserver::most_friction() const {
  return x_.segment(friction(0), joints_) +
         P_.diagonal().segment(friction(0), joints_).cwiseMax(0).cwiseSqrt();
}

/// The unknown number `to` is `factor` times the number `from` now.
void ContactObserver::replace(Eigen::Index to, Eigen::Index from, double factor) {
  x_[to] = factor * x_[from];
  P_.row(to) = factor * P_.row(from);
  P_.col(to) = factor * P_.col(from);
  traces_.row(to) = factor * traces_.row(from);
}

void ContactObserver::begin(const JointVec& q) {
  const Eigen::Index n = joints_, all = 2 * n + unknown_;
  const double step = std::max(options_.encoder_step, kSolverStep);
  if (!runs_) {
    x_ = Eigen::VectorXd::Zero(all);
    P_ = Eigen::MatrixXd::Zero(all, all);
    P_.diagonal().segment(2 * n, errors_.count()).setOnes();
    const JointVec half = 0.5 * options_.errors.friction * arm_.limits.torque;
    x_.segment(friction(0), n) = half;
    P_.diagonal().segment(friction(0), n) = half.cwiseAbs2().array() + 1e-12;
    P_.diagonal().segment(drift(0), n) = (kDrift * arm_.limits.torque).cwiseAbs2();
  }
  x_.head(n) = q;
  x_.segment(n, n).setZero();
  x_.tail(n).setZero();
  P_.topRows(2 * n).setZero();
  P_.leftCols(2 * n).setZero();
  P_.bottomRows(n).setZero();
  P_.rightCols(n).setZero();
  P_.diagonal().head(n).setConstant(step * step);
  P_.diagonal().segment(n, n).setConstant(0.01);
  P_.diagonal().tail(n) = most_friction().cwiseAbs2();
  s_ = JointVec::Zero(n);
  w_ = s_;
  told_.clear();
  seen_.clear();
  traces_ = Eigen::MatrixXd::Zero(all, n * kWindow);
  onsets_.assign(kWindow, {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)});
  newest_ = filled_ = 0;
  runs_ = true;
}

void ContactObserver::take(const JointVec& torque) {
  while (static_cast<int>(told_.size()) <= options_.late_steps) told_.push_back(torque);
  told_.back() = torque;
}

std::optional<NoticedContact> ContactObserver::look(std::span<const double> qpos,
                                                    std::span<const double> qvel) {
  const JointVec q = arm_positions(arm_, qpos);
  qpos_.assign(qpos.begin(), qpos.end());
  qvel_.assign(qvel.begin(), qvel.end());
  if (!runs_ || told_.empty() || (q - x_.head(joints_)).cwiseAbs().maxCoeff() > kContactJump) {
    begin(q);
    return std::nullopt;
  }
  const JointVec torque = told_.front();
  told_.pop_front();
  predict(torque);
  correct(q);
  find_moving(q);
  return weigh();
}

void ContactObserver::predict(const JointVec& torque) {
  const Eigen::Index n = joints_;
  const JointVec q = x_.head(n), v = x_.segment(n, n);
  for (int i = 0; i < joints_; ++i) {
    qpos_[static_cast<std::size_t>(arm_.joints[i].qpos)] = q[i];
    qvel_[static_cast<std::size_t>(arm_.joints[i].dof)] = v[i];
  }
  Eigen::MatrixXd mass = inverse_.mass_matrix(qpos_);
  mass.diagonal() += inverse_.implicit_mass();
  const JointVec rest = inverse_.torque(qpos_, qvel_, JointVec::Zero(n));
  const Eigen::MatrixXd inv = solve_symmetric(mass, Eigen::MatrixXd::Identity(n, n));

  Eigen::MatrixXd A(n, unknown_);
  A.middleCols(errors_.count(), n) = (-s_).asDiagonal();
  A.middleCols(errors_.count() + n, n).setIdentity();
  A.rightCols(n).setIdentity();
  // What link errors do depends on the acceleration, and that on what they do: with the one of the
  // step before alone they would be late wherever it changes.
  for (int pass = 0; pass < 2; ++pass) {
    A.leftCols(errors_.count()) = -errors_.torques(q, v, w_);
    w_ = inv * (torque - rest + A * x_.tail(unknown_));
  }
  x_.segment(n, n) += h_ * w_;
  x_.head(n) += h_ * x_.segment(n, n);

  const Eigen::MatrixXd G = h_ * inv * A;
  carry(P_, G, h_);  // F P F^T
  P_.transposeInPlace();
  carry(P_, G, h_);
  P_ = 0.5 * (P_ + P_.transpose().eval());  // rounding must not grow
  P_.diagonal().segment(2 * n, errors_.count()).array() += kForgets * kForgets * h_;
  carry(traces_, G, h_);
  P_.diagonal().segment(friction(0), n) += h_ * (kRubs * arm_.limits.torque).cwiseAbs2();
  P_.diagonal().segment(drift(0), n) += h_ * (kDrift * arm_.limits.torque).cwiseAbs2();
  const JointVec rubs = kStanding * most_friction();
  for (int i = 0; i < joints_; ++i) {
    if (s_[i] != 0) continue;
    replace(standing(i), standing(i), kKept);
    P_(standing(i), standing(i)) += (1 - kKept * kKept) * rubs[i] * rubs[i];
  }
  add_torque_noise(P_, inv, (options_.torque_noise * torque).cwiseAbs2(), h_);

  newest_ = (newest_ + 1) % kWindow;
  filled_ = std::min(filled_ + 1, kWindow);
  traces_.middleCols(newest_ * n, n).setZero();
  onsets_[static_cast<std::size_t>(newest_)].information.setZero();
  onsets_[static_cast<std::size_t>(newest_)].evidence.setZero();
  for (int k = 0; k < kWindow; ++k) {
    traces_.block(n, k * n, n, n) += h_ * inv;
    traces_.block(0, k * n, n, n) += h_ * h_ * inv;
  }
}

void ContactObserver::correct(const JointVec& q) {
  const Eigen::Index n = joints_;
  const double step = std::max(options_.encoder_step, kSolverStep);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double same =
        rounded_alike(std::abs(x_[n + i]) * h_ / step, h_ * h_ * std::abs(w_[i]) / step);
    const double S = P_(i, i) + same * step * step / 12;
    const double off = q[i] - x_[i];
    const Eigen::VectorXd K = P_.col(i) / S;
    x_ += K * off;
    P_.noalias() -= S * K * K.transpose();
    const Eigen::RowVectorXd g = traces_.row(i);
    for (int k = 0; k < kWindow; ++k) {
      const auto part = g.segment(k * n, n);
      Onset& onset = onsets_[static_cast<std::size_t>(k)];
      onset.information.noalias() += part.transpose() * part / S;
      onset.evidence += part.transpose() * (off / S);
    }
    traces_.noalias() -= K * g;
  }
}

/// Which way each joint moves, for the friction of the step that comes.
void ContactObserver::find_moving(const JointVec& q) {
  const Eigen::Index n = joints_;
  seen_.push_back(q);
  if (seen_.size() > kLongLook + 1) seen_.pop_front();
  const double step = std::max(options_.encoder_step, kSolverStep);
  const JointVec& before = seen_[seen_.size() > kShortLook ? seen_.size() - 1 - kShortLook : 0];
  for (int i = 0; i < joints_; ++i) {
    const double v = x_[n + i], sign = v < 0 ? -1 : 1;
    const double spread = 4 * std::sqrt(std::max(0.0, P_(n + i, n + i)));
    if (s_[i] != 0) {
      const double slow = std::max({std::min(spread, 0.05), 2 * h_ * std::abs(w_[i]), 2e-3});
      if (std::abs(v) >= slow && s_[i] == sign) continue;
      replace(standing(i), friction(i), -s_[i]);
      s_[i] = 0;
    } else {
      const bool moved =
          (q[i] - before[i]) * sign > 2.5 * step || (q[i] - seen_.front()[i]) * sign > 3.5 * step;
      if (!moved || (q[i] - before[i]) * sign <= 0.5 * step || std::abs(v) <= 4e-3) continue;
      replace(standing(i), friction(i), 0);
      s_[i] = sign;
    }
  }
}

std::optional<NoticedContact> ContactObserver::weigh() {
  surprise_ = 0;
  std::optional<NoticedContact> out;
  for (int age = 1; age < filled_; ++age) {
    const int k = (newest_ - age + kWindow) % kWindow;
    const Onset& onset = onsets_[static_cast<std::size_t>(k)];
    const JointVec torque = explain(onset);
    const double surprise = torque.dot(onset.evidence);
    if (surprise <= surprise_) continue;
    surprise_ = surprise;
    if (surprise < options_.surprise) continue;
    out = {.torque = torque,
           .since = (age + 1) * h_,
           .surprise = surprise,
           .information = onset.information,
           .evidence = onset.evidence};
  }
  return out;
}

JointVec ContactObserver::explain(const Onset& onset) const {
  Eigen::MatrixXd C = onset.information;
  C.diagonal() += prior_;
  return solve_symmetric(C, onset.evidence);
}

JointVec ContactObserver::torque() const {
  if (onsets_.empty()) return JointVec::Zero(prior_.size());
  return explain(onsets_[static_cast<std::size_t>((newest_ + 1) % kWindow)]);
}

}  // namespace mjarm
