#include "apps/bench/robust_lap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/payload.hpp"
#include "mjarm/model/wrong_model.hpp"
#include "mjarm/path/solve_path.hpp"
#include "mjarm/sim/imperfect_drives.hpp"

namespace mjarm::app {
namespace {

constexpr double kPayload = 2;          // [kg] that the controller takes to hang at the tool
constexpr double kPayloadError = 0.2;   // of its mass, either way
constexpr double kPayloadShift = 0.02;  // [m] of its centre of mass
constexpr double kSpeed = 0.27;         // [m/s] of the tool
constexpr int kLaps = 2;
constexpr double kRamp = 1;          // [s] from rest to that speed
constexpr double kWarmUp = 1;        // [s] for which the joints go to and fro
constexpr double kWarmUpWay = 0.01;  // [rad] to either side
constexpr double kRest = 0.5;        // [s] before the laps
constexpr double kRestAfter = 1;     // [s]
constexpr double kRippleTime = 0.1;  // [s]

/// How far the tool has come after `t` of `total` seconds: its acceleration is 30 x^2 (1 - x)^2
/// over the ramps.
double way_after(double t, double total) {
  const auto ramp = [](double x) {
    x = std::clamp(x, 0.0, 1.0);
    return kSpeed * kRamp * x * x * x * x * (2.5 - x * (3 - x));
  };
  const double up = ramp(t / kRamp) + kSpeed * std::max(0.0, t - kRamp);
  return up - ramp((t - total + kRamp) / kRamp) - kSpeed * std::max(0.0, t - total);
}

/// To and fro around 0, at rest at both ends.
double warm_up(double t) {
  if (t <= 0 || t >= kWarmUp) return 0;
  const double x = t / kWarmUp, swell = std::sin(std::numbers::pi * x);
  return kWarmUpWay * swell * swell * std::sin(2 * std::numbers::pi * x) / 0.65;
}

Eigen::Vector3d point_at(const Ellipse& ellipse, double theta) {
  const EllipseAxes axes = ellipse_axes(ellipse.normal);
  return ellipse.center + ellipse.a * std::cos(theta) * axes.u +
         ellipse.b * std::sin(theta) * axes.v;
}

/// Distance of `p` from an ellipse near to `theta`, by Newton's method on the angle of its foot.
double distance_to(const Ellipse& ellipse, const Eigen::Vector3d& p, double theta) {
  constexpr int kIterations = 8;
  const EllipseAxes axes = ellipse_axes(ellipse.normal);
  for (int i = 0; i < kIterations; ++i) {
    const double c = std::cos(theta), s = std::sin(theta);
    const Eigen::Vector3d off = point_at(ellipse, theta) - p;
    const Eigen::Vector3d tangent = -ellipse.a * s * axes.u + ellipse.b * c * axes.v;
    const Eigen::Vector3d bend = -ellipse.a * c * axes.u - ellipse.b * s * axes.v;
    theta -= off.dot(tangent) / (tangent.squaredNorm() + off.dot(bend));
  }
  return (point_at(ellipse, theta) - p).norm();
}

/// Distances of the tool and what becomes of them.
class LapMeter {
 public:
  LapMeter(const RobustLaps& laps, double h) : laps_(laps), h_(h) {}

  void look(const Eigen::Vector3d& p, std::size_t step) {
    p_.push_back(p);
    const double theta = laps_.theta[step];
    off_.emplace_back(p - point_at(laps_.ellipse, theta));
    distance_.push_back(distance_to(laps_.ellipse, p, theta));
    s_.push_back(laps_.s[step]);
  }

  /// Of all steps that were looked at.
  void measure(RobustWorld& out) const {
    const double quarter = laps_.around / 4;
    for (std::size_t i = 0; i < p_.size(); ++i) {
      if (s_[i] <= 0) continue;
      double& worst = s_[i] < quarter ? out.first_quarter : out.max;
      worst = std::max(worst, distance_[i]);
      if (s_[i] >= quarter) out.lag = std::max(out.lag, off_[i].norm());
    }
    out.error = distance_;
    out.ripple = ripple();
    const auto still = static_cast<std::size_t>(kRestAfter / 2 / h_);
    for (std::size_t i = p_.size() - still; i < p_.size(); ++i) {
      out.rest = std::max(out.rest, (p_[i] - p_.back()).norm());
    }
  }

 private:
  [[nodiscard]] double ripple() const {
    const auto window = static_cast<std::size_t>(kRippleTime / h_);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = window; i < laps_.end; ++i) {
      if (s_[i - window] < laps_.around / 4) continue;
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (std::size_t k = i - window; k < i; ++k) mean += off_[k] / static_cast<double>(window);
      sum += (off_[i - window / 2] - mean).squaredNorm();
      ++count;
    }
    return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
  }

  const RobustLaps& laps_;
  double h_;
  std::vector<Eigen::Vector3d> p_, off_;
  std::vector<double> distance_, s_;
};

/// The true arm: `bare` with wrong links and friction, and a wrong load.
Result<WrongArm> draw_arm(const Robot& bare, Rng& rng) {
  const Result<Model> fine =
      bare.model.with_physics({.timestep = bare.model.timestep() / kRobustSubsteps});
  if (!fine) return fail(fine.error());
  Result<Model> wrong = wrong_model(*fine, bare.arm, {}, rng);
  if (!wrong) return fail(wrong.error());
  const double mass = kPayload * (1 + kPayloadError * rng.uniform(-1, 1));
  const Eigen::Vector3d way(rng.normal(), rng.normal(), rng.normal());
  return WrongArm{std::move(*wrong), {mass, kPayloadShift * way.normalized()}};
}

/// The same as it is driven, with that load or without.
Result<Model> driven_model(const WrongArm& drawn, const Robot& bare, bool loaded) {
  const Payload payload = loaded ? drawn.payload : Payload{};
  const Result<Model> model = with_payload(drawn.empty, bare.arm.tip, payload);
  if (!model) return fail(model.error());
  return with_torque_drives({*model, bare.arm}).model;
}

}  // namespace

Result<Model> draw_wrong_world(const Robot& bare, Rng& rng) {
  const Result<WrongArm> drawn = draw_arm(bare, rng);
  if (!drawn) return fail(drawn.error());
  return driven_model(*drawn, bare, true);
}

Result<Robot> known_robot(const Robot& robot) {
  const Result<Model> loaded = with_payload(robot.model, robot.arm.tip, {.mass = kPayload});
  if (!loaded) return fail(loaded.error());
  return with_torque_drives({*loaded, robot.arm});
}

Result<WrongArm> draw_wrong_arm(const Robot& bare, std::uint64_t seed, std::uint64_t world) {
  Rng rng(seed, world);
  return draw_arm(bare, rng);
}

std::vector<JointVec> warm_up_at(const JointVec& q, double timestep) {
  std::vector<JointVec> out;
  const auto steps = static_cast<std::size_t>((kWarmUp + kRest) / timestep);
  for (std::size_t i = 0; i < steps; ++i) {
    const double off = warm_up(static_cast<double>(i) * timestep);
    out.push_back(q + JointVec::Constant(q.size(), off));
  }
  return out;
}

Result<RobustLaps> robust_laps(const Robot& robot) {
  const Result<Robot> known = known_robot(robot);
  if (!known) return fail(known.error());
  const Ellipse ellipse{
      {0, -0.45, 0.4}, 0.3, 0.15, Eigen::Vector3d::UnitZ(), from_euler({std::numbers::pi, 0, 0})};
  const double around = ellipse_arc_length(ellipse.a, ellipse.b, 2 * std::numbers::pi);
  RobustLaps out{*known, ellipse, around};
  const Arm& arm = out.robot.arm;
  const IkSolver ik(arm);
  const auto path = solve_path(ik, ellipse_points(ellipse, 200), as_span(arm.home));
  if (!path) return fail(Errc::impossible, describe(path.error(), arm));

  const double h = out.robot.model.timestep();
  out.q = warm_up_at(path->q.front(), h);
  out.s.assign(out.q.size(), 0.0);
  out.theta.assign(out.q.size(), 0.0);
  const double total = kLaps * around / kSpeed + kRamp;
  out.end = out.q.size() + static_cast<std::size_t>(total / h);
  const auto steps = static_cast<std::size_t>((total + kRestAfter) / h);
  JointVec q = path->q.front();
  for (std::size_t i = 0; i < steps + 2; ++i) {
    out.s.push_back(way_after(static_cast<double>(i) * h, total));
    out.theta.push_back(ellipse_angle(ellipse.a, ellipse.b, out.s.back()));
    const Pose goal{point_at(ellipse, out.theta.back()), ellipse.R};
    const auto answer = ik.solve(goal, as_span(q));
    if (!answer) return fail(Errc::impossible, describe(answer.error(), arm));
    q = answer->q;
    out.q.push_back(q);
  }
  return out;
}

Result<Controller> drive_references(const WrongDrive& drive, std::uint64_t seed,
                                    std::uint64_t world, const AfterWrongStep& after) {
  Rng rng(seed, world);
  const Result<WrongArm> arm_drawn = draw_arm(drive.bare, rng);
  if (!arm_drawn) return fail(arm_drawn.error());
  const Result<Model> drawn = driven_model(*arm_drawn, drive.bare, drive.loaded);
  if (!drawn) return fail(drawn.error());
  const Arm& arm = drive.known.arm;
  Result<Controller> controller =
      Controller::create(drive.known.model, arm, drive.mode, drive.control);
  if (!controller) return fail(std::move(controller.error()));
  ImperfectDrives drives(arm, {.late_steps = drive.control.robust.late_steps},
                         drive.known.model.timestep(), rng);
  Sim sim(*drawn);
  sim.place(arm, as_span(drive.q.front()));
  std::vector<double> ctrl(sim.ctrl().begin(), sim.ctrl().end());
  for (std::size_t i = 0; i + 2 < drive.q.size(); ++i) {
    drives.read(sim.qpos(), sim.qvel());
    const StepReference reference = reference_at(drive.q, i);
    WrongStep step{
        .index = i + 1, .q = arm_positions(arm, drives.qpos()), .torque = JointVec(arm.dof())};
    step.limited = controller->command(drives.qpos(), drives.qvel(), reference, ctrl);
    for (int j = 0; j < arm.dof(); ++j) {
      const ArmActuator& actuator = *arm.joints[j].actuator;
      step.torque[j] = actuator.gear * ctrl[actuator.id];
      step.torque_use = std::max(step.torque_use, std::abs(step.torque[j]) / arm.limits.torque[j]);
    }
    drives.pass(ctrl);
    for (int k = 0; k < kRobustSubsteps; ++k) {
      if (Result<void> done = sim.step(ctrl); !done) return fail(std::move(done.error()));
    }
    after(sim, step);
  }
  return controller;
}

Result<RobustWorld> drive_wrong_world(const RobustLaps& laps, const Robot& bare, ControlMode mode,
                                      const ControlOptions& control, std::uint64_t seed,
                                      std::uint64_t world) {
  const Arm& arm = laps.robot.arm;
  LapMeter meter(laps, laps.robot.model.timestep());
  RobustWorld out;
  const auto driven = drive_references({laps.robot, bare, laps.q, mode, control}, seed, world,
                                       [&](const Sim& sim, const WrongStep& step) {
                                         out.limited_steps += step.limited ? 1 : 0;
                                         out.torque_use = std::max(out.torque_use, step.torque_use);
                                         meter.look(sim.tool(arm).p, step.index);
                                       });
  if (!driven) return fail(driven.error());
  meter.measure(out);
  const JointVec share =
      driven->friction().cwiseQuotient(ModelErrors{}.friction * arm.limits.torque);
  out.friction = (share - JointVec::Ones(arm.dof())).cwiseAbs().maxCoeff();
  return out;
}

}  // namespace mjarm::app
