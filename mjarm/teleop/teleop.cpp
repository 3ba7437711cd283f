#include "mjarm/teleop/teleop.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/messages/teleop.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/track.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/teleop/grasp_watch_internal.hpp"

namespace mjarm {
namespace {

constexpr double kFaster = 0.04;  // of the speed asked for, a period, once it is free again
constexpr double kSlower[] = {1, 0.7, 0.4, 0.15};  // of that, what is tried
constexpr double kLeastTried = 0.02;
constexpr double kLeastSingular = 0.1;  // of the speed asked for
constexpr double kArmLength = 0.2;      // [m] that weighs as much as 1 rad
constexpr double kStray = 2e-3;         // [m] off the way that is not made good any more
constexpr double kRangeReserve = 1e-4;  // [rad or m] kept from the ends of joints' ranges
constexpr double kPushed = 0.02;        // [rad or m] a joint is off its reference at most
constexpr double kGripping = 0.02;      // command above which fingers may hold something

/// What is not a number is nothing; longer than `max` is as long.
Eigen::Vector3d bounded(const Eigen::Vector3d& value, double max) {
  if (!value.allFinite()) return Eigen::Vector3d::Zero();
  const double length = value.norm();
  return length > max ? Eigen::Vector3d(value * (max / length)) : value;
}

/// Joint velocities, and what held them back.
struct WantedVelocity {
  JointVec v;
  TeleopLimit limit = TeleopLimit::none;
  int joint = -1;
};

Result<void> check_teleop(const TeleopOptions& options) {
  const auto above = [](const char* what, double value, bool share) -> Result<void> {
    if (value > 0 && std::isfinite(value) && (!share || value <= 1)) return {};
    return fail(Errc::bad_input,
                text(msg::teleop_bad_option, what,
                     share ? text(msg::teleop_at_most_one) : std::string(), value));
  };
  for (const auto& [what, value, share] :
       {std::tuple("period", options.period, false), std::tuple("speed", options.speed, false),
        std::tuple("turn", options.turn, false),
        std::tuple("grip_speed", options.grip_speed, false),
        std::tuple("velocity_share", options.velocity_share, true),
        std::tuple("acceleration_share", options.acceleration_share, true),
        std::tuple("near_singular", options.near_singular, false)}) {
    if (auto fits = above(what, value, share); !fits) return fits;
  }
  return {};
}

}  // namespace

std::string_view name(TwistFrame frame) noexcept {
  return frame == TwistFrame::tool ? "tool" : "world";
}

struct Teleop::Impl {
  Impl(const Robot& robot, const TeleopOptions& chosen, int count, Controller with,
       std::optional<SceneWatch> guard)
      : arm(robot.arm),
        options(chosen),
        steps(count),
        timestep(robot.model.timestep()),
        dt(count * robot.model.timestep()),
        controller(std::move(with)),
        watch(std::move(guard)),
        grasp(robot),
        tracker(arm, {.dt = dt, .speed_share = chosen.velocity_share}),
        q(arm.home),
        v(JointVec::Zero(arm.dof())) {}

  /// [s] until the arm stands, braking along `velocity`.
  double braking_time(const JointVec& velocity) const {
    return (velocity.array().abs() / (options.acceleration_share * arm.limits.acceleration.array()))
        .maxCoeff();
  }

  /// The velocity after a period on the way to `target`, all joints alike.
  JointVec towards(const JointVec& target) const {
    const double needed = braking_time(target - v);
    return needed <= dt ? target : JointVec(v + dt / needed * (target - v));
  }

  /// The gripper's command after a period.
  double next_grip(const TeleopInput& input) const {
    const double most = dt * options.grip_speed;
    double by = dt * input.grip;
    if (input.grip_to) by = std::clamp(*input.grip_to, 0.0, 1.0) - grip;
    return std::isfinite(by) ? std::clamp(grip + std::clamp(by, -most, most), 0.0, 1.0) : grip;
  }

  bool gives_way(const Sim& sim);
  WantedVelocity wanted(const TeleopInput& input);
  void follow_goal(const JointVec& q_before);
  bool range_allows(const JointVec& q1, const JointVec& stop, int& joint) const;
  bool allows(const JointVec& v1);
  void plan(const Sim& sim, const TeleopInput& input);
  Result<void> make_steps(Sim& sim, const JointVec& v1);

  Arm arm;
  TeleopOptions options;
  int steps;
  double timestep, dt;
  Controller controller;
  std::optional<SceneWatch> watch;
  detail::GraspWatch grasp;
  Tracker tracker;
  JointVec q, v;    ///< where the arm is led
  JointVec v_next;  ///< at the end of the period
  Pose X_WT;        ///< where the tool is led, without what steps make it stray
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();  ///< see wanted()
  double allowed = 1;  ///< share of the speed that was found free last
  double grip = 0;
  int held = -1;
  bool moves = false;
  SceneWatch::Verdict verdict;
  int range_joint = -1;
  TeleopState last;
  std::vector<double> ctrl;
};

/// An arm that meets something it may push stays behind, or fingers that open against something
/// push it away. Then its reference stops at once, and comes after it where that is free; the
/// gripper waits. So nothing presses ever harder, and the arm is not bent into itself.
bool Teleop::Impl::gives_way(const Sim& sim) {
  const JointVec here = sim.arm_state(arm).q, off = q - here;
  if (off.cwiseAbs().maxCoeff() <= kPushed || !grasp.touches(sim, held)) return false;
  v.setZero();
  allowed = 0;
  const JointVec after = here + off.cwiseMax(-kPushed).cwiseMin(kPushed);
  if (watch) watch->take(sim.qpos(), q, held);
  if (!watch || watch->check_way(after, after).free) q = after;
  X_WT = fk(arm, as_span(q));
  return true;
}

/// What Tracker makes of the input, slower near singularities. `twist` is then what the input asks
/// for in this period, in the world frame: [m], below it [rad].
WantedVelocity Teleop::Impl::wanted(const TeleopInput& input) {
  Eigen::Vector3d linear = bounded(input.linear, options.speed);
  Eigen::Vector3d angular = bounded(input.angular, options.turn);
  if (linear.isZero(0) && angular.isZero(0)) {
    X_WT = fk(arm, as_span(q));
    twist.setZero();
    return {JointVec::Zero(arm.dof()), TeleopLimit::none, -1};
  }
  if (input.frame == TwistFrame::tool) {
    linear = X_WT.R * linear;
    angular = X_WT.R * angular;
  }
  twist << dt * linear, dt * angular;
  const Pose goal{X_WT.p + twist.head<3>(), rotation_exp(twist.tail<3>()) * X_WT.R};
  const TrackStep step = tracker.step(goal, as_span(q));
  WantedVelocity out{(step.q - q) / dt, TeleopLimit::none, -1};
  if (step.speed_scale < 1) {
    out.limit = TeleopLimit::joint_speed;
    (out.v.array().abs() / arm.limits.velocity.array()).maxCoeff(&out.joint);
  }
  const double here = smallest_singular_value(fk_jacobian(arm, as_span(q)).J_W);
  if (here < options.near_singular &&
      smallest_singular_value(fk_jacobian(arm, as_span(step.q)).J_W) < here) {
    out.v *= std::max(kLeastSingular, here / options.near_singular);
    out.limit = TeleopLimit::singularity;
  }
  return out;
}

/// The goal goes as far as the tool went along the twist; across it what the tool strays is made
/// good in the next period.
void Teleop::Impl::follow_goal(const JointVec& q_before) {
  const Pose before = fk(arm, as_span(q_before)), now = fk(arm, as_span(q));
  Eigen::Matrix<double, 6, 1> went;
  went << now.p - before.p, kArmLength * rotation_log(now.R * before.R.transpose());
  Eigen::Matrix<double, 6, 1> way = twist;
  way.tail<3>() *= kArmLength;
  const double share = way.isZero(0) ? 0 : went.dot(way) / way.squaredNorm();
  X_WT = {X_WT.p + share * twist.head<3>(), rotation_exp(share * twist.tail<3>()) * X_WT.R};
  const double stray = (X_WT.p - now.p).norm() + kArmLength * angle_between(X_WT.R, now.R);
  if (stray > kStray) X_WT = now;
}

/// Whether the arm that goes to `q1` and brakes at `stop` stays in the joints' ranges, or comes
/// back to them.
bool Teleop::Impl::range_allows(const JointVec& q1, const JointVec& stop, int& joint) const {
  for (int k = 0; k < arm.dof(); ++k) {
    const double high = std::max(q1[k], stop[k]), low = std::min(q1[k], stop[k]);
    const bool above = high > arm.limits.upper[k] - kRangeReserve && high > q[k];
    const bool below = low < arm.limits.lower[k] + kRangeReserve && low < q[k];
    if (!above && !below) continue;
    joint = k;
    return false;
  }
  return true;
}

bool Teleop::Impl::allows(const JointVec& v1) {
  const JointVec q1 = q + 0.5 * dt * (v + v1);
  const JointVec stop = q1 + 0.5 * braking_time(v1) * v1;
  range_joint = -1;
  verdict = {};
  if (!range_allows(q1, stop, range_joint)) return false;
  if (!watch) return true;
  verdict = watch->check_way(q1, stop);
  return verdict.free;
}

void Teleop::Impl::plan(const Sim& sim, const TeleopInput& input) {
  const WantedVelocity want = wanted(input);
  last = {.scale = 1, .limit = want.limit};
  if (want.joint >= 0) last.joint = arm.joints[static_cast<std::size_t>(want.joint)].name;
  const bool asked = !want.v.isZero(0);
  moves = asked || !v.isZero(0);
  if (!moves) {
    v_next = v;
    return;
  }
  if (watch) watch->take(sim.qpos(), q, held);
  v_next = towards(JointVec::Zero(arm.dof()));
  if (!asked) return;
  const double first = std::min(1.0, allowed + kFaster);
  SceneWatch::Verdict why;
  int why_joint = -1;
  allowed = 0;
  for (const double share : kSlower) {
    const double tried = share * first;
    if (tried < kLeastTried) break;
    const JointVec v1 = towards(tried * want.v);
    if (allows(v1)) {
      v_next = v1;
      allowed = tried;
      break;
    }
    if (share == 1) {
      why = verdict;
      why_joint = range_joint;
    }
  }
  last.scale = allowed;
  if (why.free && why_joint < 0) return;
  last.limit = why_joint >= 0 ? TeleopLimit::joint_range : TeleopLimit::near;
  if (why_joint >= 0) last.joint = arm.joints[static_cast<std::size_t>(why_joint)].name;
  if (!why.free) last.near = watch->near(why);
}

Result<void> Teleop::Impl::make_steps(Sim& sim, const JointVec& v1) {
  const JointVec a = (v1 - v) / dt, q0 = q, v0 = v;
  const auto at = [&](double t) -> JointVec {
    return t < 0 ? JointVec(q0 + t * v0) : JointVec(q0 + t * v0 + 0.5 * t * t * a);
  };
  for (int i = 0; i < steps; ++i) {
    const StepReference reference{at((i - 1) * timestep), at(i * timestep), at((i + 1) * timestep)};
    (void)controller.command(sim.qpos(), sim.qvel(), reference, ctrl);
    if (auto done = sim.step(ctrl); !done) return done;
  }
  q = q0 + 0.5 * dt * (v0 + v1);
  v = v1;
  return {};
}

Teleop::Teleop(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Teleop::~Teleop() = default;
Teleop::Teleop(Teleop&&) noexcept = default;
Teleop& Teleop::operator=(Teleop&&) noexcept = default;

Result<Teleop> Teleop::create(const Robot& robot, const TeleopOptions& options) {
  if (auto fits = check_teleop(options); !fits) return fail(std::move(fits.error()));
  Result<Controller> controller =
      Controller::create(robot.model, robot.arm, ControlMode::computed_torque);
  if (!controller) return fail(Errc::not_available, controller.error().what);
  std::optional<SceneWatch> watch;
  if (options.guard) {
    Result<SceneWatch> made = SceneWatch::create(robot.model, robot.arm, options.watch);
    if (!made) return fail(std::move(made.error()));
    watch.emplace(std::move(*made));
  }
  const int steps =
      std::max(1, static_cast<int>(std::lround(options.period / robot.model.timestep())));
  return Teleop(
      std::make_unique<Impl>(robot, options, steps, std::move(*controller), std::move(watch)));
}

void Teleop::begin(Sim& sim) {
  Impl& own = *impl_;
  sim.hold_others(own.arm);
  own.q = sim.arm_state(own.arm).q;
  own.v.setZero();
  own.X_WT = fk(own.arm, as_span(own.q));
  own.allowed = 1;
  own.held = -1;
  own.ctrl.assign(sim.ctrl().begin(), sim.ctrl().end());
  own.controller.restart();
  own.last = {};
  own.grip = 0;
  if (!own.arm.gripper) return;
  own.grip = std::clamp(grip_of(*own.arm.gripper, own.ctrl), 0.0, 1.0);
}

Result<void> Teleop::advance(Sim& sim, const TeleopInput& input) {
  Impl& own = *impl_;
  const bool pushed = own.gives_way(sim);
  if (own.arm.gripper) {
    if (!pushed) own.grip = own.next_grip(input);
    set_grip(*own.arm.gripper, own.grip, own.ctrl);
    own.held = own.grasp.held(sim, own.grip > kGripping, own.held);
  }
  own.plan(sim, input);
  if (pushed) own.last.limit = TeleopLimit::pushed;
  const JointVec before = own.q;
  if (auto done = own.make_steps(sim, own.v_next); !done) return done;
  own.follow_goal(before);
  return {};
}

TeleopState Teleop::state() const {
  TeleopState out = impl_->last;
  out.grip = impl_->grip;
  out.held = impl_->grasp.name(impl_->held);
  if (!out.near && impl_->watch && impl_->moves) out.near = impl_->watch->nearest();
  return out;
}

double Teleop::period() const noexcept { return impl_->dt; }
const JointVec& Teleop::reference() const noexcept { return impl_->q; }

TeleopMoment Teleop::moment(const Sim& sim) const {
  return {sim.snapshot(), impl_->q,       impl_->v,   impl_->X_WT,
          impl_->grip,    impl_->allowed, impl_->held};
}

Result<void> Teleop::go_to(Sim& sim, const TeleopMoment& moment) {
  if (moment.q.size() != impl_->q.size()) {
    return fail(Errc::bad_input, text(msg::teleop_other_arm, moment.q.size(), impl_->q.size()));
  }
  if (auto done = sim.restore(moment.world); !done) return done;
  impl_->q = moment.q;
  impl_->v = moment.v;
  impl_->X_WT = moment.X_WT;
  impl_->grip = moment.grip;
  impl_->allowed = moment.allowed;
  impl_->held = moment.held;
  impl_->last = {};
  impl_->controller.restart();
  impl_->ctrl.assign(sim.ctrl().begin(), sim.ctrl().end());
  return {};
}

}  // namespace mjarm
