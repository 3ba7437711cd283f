#include "apps/bench/control_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/ellipse.hpp"
#include "mjarm/path/solve_path.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {
namespace {

/// The share of the way that a quintic has gone after the share `x` of the time.
double quintic(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 - x * (15 - 6 * x));
}

/// Drives one lap; everything it needs besides the options.
class Lap {
 public:
  Lap(const Model& world, const Arm& arm, Controller controller, Curve curve, JointVec q_start,
      double seconds)
      : arm_(arm),
        ik_(arm),
        controller_(std::move(controller)),
        curve_(std::move(curve)),
        sim_(world),
        h_(world.timestep()),
        steps_(static_cast<long>(std::ceil(seconds / h_))),
        seconds_(seconds),
        ctrl_(static_cast<std::size_t>(world.nu()), 0.0) {
    sim_.place(arm, as_span(q_start));
    std::ranges::copy(sim_.ctrl(), ctrl_.begin());
    reference_ = hold(as_span(q_start));
  }

  Result<LapResult> drive() {
    LapResult out;
    std::vector<Eigen::Vector3d> p_W{sim_.tool(arm_).p};
    const Stopwatch watch;
    for (long i = 0; i < steps_; ++i) {
      if (Result<void> done = step(i, out); !done) return fail(std::move(done.error()));
      const Eigen::Vector3d p = sim_.tool(arm_).p;
      out.lag = std::max(out.lag, (p - goal_.p).norm());
      p_W.push_back(p);
    }
    out.rtf = static_cast<double>(steps_) * h_ / (1e-6 * watch.us());
    out.error = path_error(curve_, p_W);
    const std::span<const Eigen::Vector3d> half = std::span(p_W).subspan(p_W.size() / 2);
    out.second_half = path_error(curve_, half).max;
    return out;
  }

 private:
  Result<void> step(long i, LapResult& out) {
    const double s = curve_.end() * quintic(static_cast<double>(i + 1) * h_ / seconds_);
    out.peak_speed = std::max(out.peak_speed, (s - s_) / h_);
    s_ = s;
    goal_ = curve_.at(s);
    const auto answer = ik_.solve(goal_, as_span(reference_.next));
    if (!answer) return fail(Errc::impossible, describe(answer.error(), arm_));
    reference_ = {reference_.now, reference_.next, answer->q};
    const JointVec v = (reference_.next - reference_.now) / h_;
    out.velocity_use =
        std::max(out.velocity_use, v.cwiseQuotient(arm_.limits.velocity).cwiseAbs().maxCoeff());
    out.peak_acceleration =
        std::max(out.peak_acceleration, reference_.acceleration(h_).cwiseAbs().maxCoeff());
    out.limited_steps += controller_.command(sim_.qpos(), sim_.qvel(), reference_, ctrl_) ? 1 : 0;
    return sim_.step(ctrl_);
  }

  const Arm& arm_;
  IkSolver ik_;
  Controller controller_;
  Curve curve_;
  Sim sim_;
  double h_;
  long steps_;
  double seconds_;
  std::vector<double> ctrl_;
  StepReference reference_;
  Pose goal_;
  double s_ = 0;
};

}  // namespace

Result<LapResult> drive_lap(const Model& model, const Arm& arm, const LapOptions& options) {
  const Ellipse ellipse{options.center, options.a, options.b, Eigen::Vector3d::UnitZ(),
                        from_euler({std::numbers::pi, 0, 0})};
  const Result<Curve> curve = Curve::ellipse(ellipse);
  if (!curve) return fail(curve.error());
  constexpr int kPoints = 200;
  const std::vector<Pose> poses = ellipse_points(ellipse, kPoints);
  const auto path = solve_path(IkSolver(arm), poses, as_span(arm.home));
  if (!path) return fail(Errc::impossible, describe(path.error(), arm));
  Result<Controller> controller = Controller::create(model, arm, options.mode, options.control);
  if (!controller) return fail(std::move(controller.error()));
  Result<Model> world = model;
  if (options.payload > 0) world = model.with_point_mass(arm.tip, options.payload);
  if (!world) return fail(world.error());
  return Lap(*world, arm, std::move(*controller), *curve, path->q.front(), options.seconds).drive();
}

Result<RestResult> rest_errors(const Model& model, const Arm& arm, ControlMode mode, int poses,
                               std::uint64_t seed) {
  constexpr double kSeconds = 2;
  constexpr int kMaxDraws = 1000;  // for each pose
  constexpr double kNudge = 0.05;  // [rad or m] so far off it begins
  Rng rng(seed);
  ExactChecker checker(model, arm);
  RestResult out;
  for (int draw = 0; out.poses < poses && draw < kMaxDraws * poses; ++draw) {
    JointVec q(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      q[i] = rng.uniform(std::max(arm.limits.lower[i], -std::numbers::pi),
                         std::min(arm.limits.upper[i], std::numbers::pi));
    }
    if (!checker.is_free(as_span(q))) continue;
    Result<Controller> controller = Controller::create(model, arm, mode);
    if (!controller) return fail(std::move(controller.error()));
    JointVec q_start = q;
    for (double& value : q_start) value += rng.uniform(-kNudge, kNudge);
    Sim sim(model);
    sim.place(arm, as_span(clamp_to_limits(arm, as_span(q_start))));
    std::vector<double> ctrl(sim.ctrl().begin(), sim.ctrl().end());
    const StepReference reference = hold(as_span(q));
    bool touched = false;
    for (double t = 0; t < kSeconds && !touched; t += model.timestep()) {
      controller->command(sim.qpos(), sim.qvel(), reference, ctrl);
      if (Result<void> done = sim.step(ctrl); !done) return fail(std::move(done.error()));
      touched = !sim.contacts(arm).empty();
    }
    if (touched) continue;
    const PoseError error = pose_error(fk(arm, as_span(q)), sim.tool(arm));
    out.worst.position = std::max(out.worst.position, error.position);
    out.worst.rotation = std::max(out.worst.rotation, error.rotation);
    ++out.poses;
  }
  return out;
}

}  // namespace mjarm::app
