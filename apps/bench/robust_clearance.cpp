#include "apps/bench/robust_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robust_lap.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/execution/path_motion.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/planning_world.hpp"

namespace mjarm::app {
namespace {

constexpr double kShareOfLimits = 0.25;
constexpr double kRestThere = 0.5;  // [s]

/// From before the wall to behind it, at rest at both ends, after a warm-up: positions at every
/// step of control.
Result<std::vector<JointVec>> round_the_wall(const Robot& robot, double margin) {
  const std::vector<double> before{1.9084, -1.2456, 1.9905, -2.3157, -1.5708, 3.4792};
  const Pose behind{{-0.3, -0.45, 0.2}, from_euler({std::numbers::pi, 0, 0})};
  Result<PlanningWorld> world = PlanningWorld::create(robot, {.margin = margin});
  if (!world) return fail(std::move(world.error()));
  const auto path = world->plan(before, behind, {.rounds = 8});
  if (!path) return fail(Errc::impossible, path.error().what);
  const auto prover = world->prover({&*path, 1});
  if (!prover) return fail(prover.error());
  JointLimits limits = robot.arm.limits;
  limits.velocity *= kShareOfLimits;
  limits.acceleration *= kShareOfLimits;
  const auto motion = time_path(path->q, limits, *prover);
  if (!motion) return fail(motion.error());
  const Trajectory& trajectory = motion->trajectory;
  const double h = robot.model.timestep();
  std::vector<JointVec> q = warm_up_at(path->q.front(), h);
  const auto steps = static_cast<int>((trajectory.duration() + kRestThere) / h);
  for (int i = 0; i < steps; ++i) q.push_back(trajectory.at(i * h).q);
  return q;
}

/// Farthest that a joint frame or the tool is from where it is at `q_ref`.
double farthest(const Arm& arm, const JointVec& q, const JointVec& q_ref) {
  std::vector<Pose> is(static_cast<std::size_t>(arm.dof())), shall(is.size());
  double out = (fk_all(arm, as_span(q), is).p - fk_all(arm, as_span(q_ref), shall).p).norm();
  for (std::size_t i = 0; i < is.size(); ++i) out = std::max(out, (is[i].p - shall[i].p).norm());
  return out;
}

}  // namespace

Result<ClearanceResult> clearance_in_wrong_worlds(double margin, int worlds, int seed) {
  const Result<Robot> robot = mjarm::load_robot("universal_robots_ur5e/wall.xml");
  if (!robot) return fail(robot.error());
  const auto q = round_the_wall(*robot, margin);
  if (!q) return fail(q.error());
  const Result<Robot> known = known_robot(*robot);
  if (!known) return fail(known.error());
  ClearanceResult out{.planned = std::numeric_limits<double>::infinity()};
  ExactChecker checker(robot->model, robot->arm);
  for (const JointVec& here : *q) {
    const auto report = checker.check(as_span(here));
    if (!report) return fail(report.error());
    if (report->nearest) out.planned = std::min(out.planned, report->nearest->distance);
  }
  const WrongDrive drive{
      *known, *robot, *q, ControlMode::robust, {.robust = {.late_steps = kRobustLate}}};
  Progress progress(text(msg::control_suite_progress), static_cast<std::size_t>(worlds));
  for (; out.worlds < worlds; ++out.worlds) {
    if (interrupted()) return fail(stopped());
    bool touched = false;
    const auto driven = drive_references(
        drive, static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(out.worlds),
        [&](const Sim& sim, const WrongStep& step) {
          touched = touched || !sim.contacts(robot->arm).empty();
          const JointVec& late = (*q)[step.index - std::min<std::size_t>(step.index, kRobustLate)];
          out.tube = std::max(out.tube, farthest(robot->arm, sim.arm_state(robot->arm).q, late));
        });
    if (!driven) return fail(driven.error());
    out.contacts += touched ? 1 : 0;
    progress.advance();
  }
  return out;
}

}  // namespace mjarm::app
