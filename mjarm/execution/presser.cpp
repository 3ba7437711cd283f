#include "mjarm/execution/presser.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/execution.hpp"

namespace mjarm {
namespace {

constexpr double kWeigh = 0.3;                         // [s] the second half of which is measured
constexpr double kSeekDamping = 150;                   // [N s/m]
constexpr double kSeekSlow = 0.005, kSeekFast = 0.03;  // [m/s]
/// [m] before the depth of the stroke before, and so much more for each metre beside it, the tool
/// slows down: 0.2 is a tilt of 11 degrees.
constexpr double kSlowDepth = 2e-3, kSlowTilt = 0.2;
constexpr double kMet = 0.3;          // of the force: it has met something
constexpr double kRight = 0.04;       // of the force: as good as right
constexpr double kCalm = 0.05;        // [s] for which it has to be right
constexpr double kPatience = 2;       // [s] until it goes on all the same
constexpr double kDamping = 8;        // [N s/m] while it presses
constexpr double kIntegral = 8;       // [1/s] below the rate of a contact, about 50
constexpr double kMostIntegral = 20;  // [N]
constexpr double kLift = 0.3;         // [s]

}  // namespace

Result<std::optional<Presser>> Presser::create(const Model& model, const MotionPlan& plan,
                                               ControlMode control) {
  if (!plan.presses()) return std::nullopt;
  if (control != ControlMode::tool_impedance) {
    return fail(Errc::usage, text(msg::execution_press_control, name(control)));
  }
  const std::optional<ForceSensor> sensor = find_force_sensor(model, plan.arms.front());
  if (!sensor) {
    return fail(Errc::not_available, text(msg::execution_press_sensor, plan.arms.front().tip));
  }
  return Presser(model, plan, *sensor);
}

Presser::Presser(const Model& model, const MotionPlan& plan, ForceSensor sensor)
    : plan_(&plan),
      sensor_(std::move(sensor)),
      links_(Chain(plan.arms.front())),
      timestep_(model.timestep()) {}

void Presser::restart() {
  enter(Phase::above);
  last_move_.reset();
  last_.reset();
  ink_.clear();
  strokes_.clear();
}

void Presser::enter(Phase phase) {
  phase_ = phase;
  steps_ = 0;
  calm_ = 0;
}

/// In the tool frame, without what hangs on the sensor.
Eigen::Vector3d Presser::force(const Sim& sim) const {
  return sensor_.force(sim.sensor_data()) - weight_;
}

bool Presser::begins_stroke(const MotionClock& clock) const {
  return clock.motion() < plan_->moves.size() && plan_->moves[clock.motion()].press &&
         clock.motion() != last_move_;
}

void Presser::weigh(const Sim& sim, const MotionClock& clock, double depth) {
  const int count = static_cast<int>(kWeigh / timestep_);
  if (steps_ == 0) {
    move_ = clock.motion();
    weight_.setZero();
    integral_ = 0;
    strokes_.push_back({.move = move_});
  }
  if (steps_ >= count / 2) {
    weight_ += sensor_.force(sim.sensor_data()) / (count - count / 2);
    // What the spring carries is a load that the controller does not know.
    integral_ -= kImpedance.tool_stiffness * depth / (count - count / 2);
  }
  if (++steps_ < count) return;
  integral_ = std::clamp(integral_, -kMostIntegral, kMostIntegral);
  enter(Phase::seek);
}

/// Goes down, the faster the farther it is above where the stroke before met something.
AxialPush Presser::seek(const Pose& X_WT, double depth) const {
  double speed = kSeekSlow;
  if (last_) {
    const Eigen::Vector3d way = X_WT.p - last_->X_WT.p;
    const double beside = (way - way.dot(X_WT.R.col(2)) * X_WT.R.col(2)).norm();
    const bool far = depth < last_->depth - kSlowDepth - kSlowTilt * beside;
    if (far) speed = kSeekFast;
  }
  return {.force = kSeekDamping * speed + integral_, .damping = kSeekDamping};
}

AxialPush Presser::push(const Pose& X_WT, double wanted, const Eigen::Vector3d& measured,
                        double damping) {
  integral_ = std::clamp(integral_ + kIntegral * timestep_ * (wanted - measured.z()),
                         -kMostIntegral, kMostIntegral);
  const Eigen::Vector3d across(-measured.x(), -measured.y(), 0);
  return {.force = wanted + integral_, .damping = damping, .across_W = X_WT.R * across};
}

/// The spring begins with the force that the push had.
void Presser::begin_lift(double depth) {
  lift_from_ = depth + integral_ / kImpedance.tool_stiffness;
  enter(Phase::lift);
}

bool Presser::look(const Sim& sim, Controller& controller, const MotionClock& clock) {
  if (phase_ == Phase::above && begins_stroke(clock)) enter(Phase::weigh);
  if (phase_ == Phase::above) return false;
  const Pose X_ref = fk(links_, as_span(clock.q_ref())), X_WT = sim.tool(plan_->arms.front());
  const double depth = X_ref.R.col(2).dot(X_WT.p - X_ref.p);
  if (phase_ == Phase::weigh) {
    weigh(sim, clock, depth);
    return true;
  }
  const Eigen::Vector3d force_T = force(sim);
  const double measured = force_T.z();
  const PlannedMove& move = plan_->moves[move_];
  const ToolPress& press = *move.press;
  PressedStroke& stroke = strokes_.back();
  switch (phase_) {
    case Phase::seek:
      if (measured > kMet * press.force) {
        stroke.touched = true;
        stroke.depth = depth;
        last_ = LastTouch{X_WT, depth};
        enter(Phase::settle);
      } else if (depth > press.reach || ++steps_ * timestep_ > 2 * press.reach / kSeekSlow) {
        begin_lift(depth);
      }
      controller.set_axial(seek(X_WT, depth), 0);
      return true;
    case Phase::settle: {
      stroke.landing = std::max(stroke.landing, measured);
      const bool right = std::abs(measured - press.force) < kRight * press.force;
      calm_ = right ? calm_ + timestep_ : 0;
      ++steps_;
      controller.set_axial(push(X_WT, press.force, force_T, kSeekDamping), 0);
      if (calm_ < kCalm && steps_ * timestep_ < kPatience) return true;
      enter(Phase::write);
      stroke.least = stroke.most = measured;
      return false;
    }
    case Phase::write:
      ink_.push_back(
          {move_, sim.time(), X_WT, (X_WT.p - X_ref.p - depth * X_ref.R.col(2)).norm(), measured});
      stroke.least = std::min(stroke.least, measured);
      stroke.most = std::max(stroke.most, measured);
      controller.set_axial(push(X_WT, press.force, force_T, kDamping), 0);
      if (clock.motion() == move_ && clock.time() < move.trajectory.duration()) return false;
      begin_lift(depth);
      return true;
    default:
      break;
  }
  // The spring takes the tool up along a cubic.
  const double share = std::min(1.0, ++steps_ * timestep_ / kLift);
  controller.set_axial(std::nullopt, lift_from_ * (1 - share * share * (3 - 2 * share)));
  if (share < 1) return true;
  last_move_ = move_;
  enter(Phase::above);
  return false;
}

}  // namespace mjarm
