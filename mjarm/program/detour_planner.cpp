#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/core/messages/program.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/program/detour_planner_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr double kWayStep = 5e-3;  // [rad or m]
constexpr int kMaxGoals = 64;      // answers to a pose
const PlanOptions kSearch{.samples = 20'000, .rounds = 16};

const char* name_of(PlanErrc reason) {
  switch (reason) {
    case PlanErrc::base_hit:
    case PlanErrc::start_hit:
    case PlanErrc::goals_hit:
      return "collision";
    case PlanErrc::start_outside:
    case PlanErrc::goals_outside:
      return "joint_limit";
    case PlanErrc::stopped:
      return "stopped";
    case PlanErrc::too_near:
      return "clearance";
    case PlanErrc::enclosed:
    case PlanErrc::barred:
    case PlanErrc::budget_spent:
    case PlanErrc::out_of_time:
    case PlanErrc::unproved:
    case PlanErrc::not_available:
    case PlanErrc::back_end:
      return "no_path";
    case PlanErrc::start_tilted:
    case PlanErrc::goals_tilted:
    case PlanErrc::start_off:
    case PlanErrc::goals_off:
      return "tilt";
    case PlanErrc::bad_clearance:
    case PlanErrc::bad_tilt:
    case PlanErrc::bad_region:
    case PlanErrc::tilt_with_ompl:
    case PlanErrc::bad_input:
      break;
  }
  return "bad_input";
}

/// The motion in steps of at most kWayStep.
std::vector<JointVec> sampled(const Trajectory& trajectory, const JointLimits& limits) {
  const double duration = trajectory.duration();
  const auto count =
      static_cast<int>(std::ceil(2 * duration * limits.velocity.maxCoeff() / kWayStep));
  std::vector<JointVec> way{trajectory.at(0).q};
  for (int i = 1; i <= count; ++i) {
    JointVec q = trajectory.at(duration * i / count).q;
    const double step = (q - way.back()).cwiseAbs().maxCoeff();
    if (i == count || step >= 0.5 * kWayStep) way.push_back(std::move(q));
  }
  return way;
}

/// The corners of all paths, and which of them are the ends of paths but the last.
struct Corners {
  std::vector<JointVec> q;
  std::vector<std::size_t> passed;
};

Corners corners_of(std::span<const PlannedPath> paths) {
  constexpr double kSame = 1e-9;
  Corners out;
  for (const PlannedPath& path : paths) {
    if (!out.q.empty()) out.passed.push_back(out.q.size() - 1);
    for (const JointVec& q : path.q) {
      if (out.q.empty() || (q - out.q.back()).norm() >= kSame) out.q.push_back(q);
    }
  }
  return out;
}

tl::unexpected<DetourFault> no_detour(std::string reason, std::string what) {
  return tl::unexpected(DetourFault{std::move(reason), std::move(what)});
}

}  // namespace

std::optional<std::string> DetourPlanner::touches(const JointVec& q) const {
  return MoveJudge::touches(judge_.measure(ik_, {q}));
}

std::optional<std::string> DetourPlanner::least_touch(const JointVec& q, const Pose& X_WT) const {
  const auto answers =
      solve_all(ik_.with({.task = ik_.options().task}), X_WT, as_span(q), {.max = kMaxGoals});
  if (!answers) return std::nullopt;
  std::optional<MoveMeasures> best;
  for (const IkSolution& answer : *answers) {
    MoveMeasures measures = judge_.measure(ik_, {answer.q});
    if (!best || measures.clearance > best->clearance) best = std::move(measures);
  }
  return MoveJudge::touches(*best);
}

Result<std::vector<JointVec>, DetourFault> DetourPlanner::goals(const JointVec& q,
                                                                const Pose& X_WT) const {
  if (const auto pair = touches(q)) {
    return no_detour("collision", text(msg::program_starts_touching, *pair));
  }
  const auto answers = solve_all(ik_, X_WT, as_span(q), {.max = kMaxGoals});
  if (!answers && answers.error().code == IkErrc::collision) {
    const auto pair = least_touch(q, X_WT);
    if (pair) return no_detour("collision", text(msg::program_no_free_answer, *pair));
  }
  if (!answers) {
    return no_detour(std::string(name(answers.error().code)),
                     describe(answers.error(), robot_.arm));
  }
  std::vector<JointVec> out;
  for (const IkSolution& answer : *answers) out.push_back(answer.q);
  return out;
}

Result<std::vector<JointVec>, DetourFault> DetourPlanner::goals(const JointVec& q,
                                                                const JointVec& goal) const {
  if (const auto pair = touches(q)) {
    return no_detour("collision", text(msg::program_starts_touching, *pair));
  }
  if (const auto beyond = judge_.beyond_limits(goal)) return no_detour("joint_limit", *beyond);
  if (const auto pair = touches(goal)) {
    return no_detour("collision", text(msg::program_ends_touching, *pair));
  }
  return std::vector<JointVec>{goal};
}

JointLimits DetourPlanner::limits_at(double share) const {
  JointLimits limits = robot_.arm.limits;
  limits.velocity *= share;
  limits.acceleration *= share;
  return limits;
}

Result<PlanningWorld*> DetourPlanner::world() {
  if (!world_) {
    Result<PlanningWorld> made = PlanningWorld::create(robot_, options_);
    if (!made) return fail(std::move(made.error()));
    world_ = std::move(*made);
  }
  return &*world_;
}

Result<WayProver> DetourPlanner::prover_of(std::span<const PlannedPath> paths) {
  const Result<PlanningWorld*> here = world();
  if (!here) return fail(here.error());
  return (*here)->prover(paths, stop_);
}

bool DetourPlanner::lead_into(const JointState& end, std::span<const PlannedPath> paths,
                              double share, Trajectory& motion, MoveMeasures& measures) {
  const JointLimits limits = limits_at(share);
  const Result<WayProver> prover = prover_of(paths);
  if (!prover) return false;
  std::optional<Trajectory> led = mjarm::lead_into(motion, end, limits, *prover);
  if (!led) return false;
  MoveMeasures found = judge_.measure(ik_, sampled(*led, limits));
  if (MoveJudge::touches(found)) return false;
  motion = std::move(*led);
  measures = std::move(found);
  return true;
}

Result<DetourMotion, DetourFault> DetourPlanner::timed(std::vector<PlannedPath> paths,
                                                       double share) {
  const JointLimits limits = limits_at(share);
  const Result<WayProver> prover = prover_of(paths);
  if (!prover) return no_detour("bad_input", prover.error().what);
  Corners corners = corners_of(paths);
  Result<PathMotion> motion =
      time_path(corners.q, limits, *prover, {.passed = corners.passed, .stop = stop_});
  if (!motion) return no_detour("timing", motion.error().what);
  DetourMotion out;
  out.measures = judge_.measure(ik_, sampled(motion->trajectory, limits));
  if (const auto pair = MoveJudge::touches(out.measures)) {
    return no_detour("collision", text(msg::program_move_touches, *pair));
  }
  out.motion = std::move(*motion);
  out.corners = std::move(corners.q);
  out.passed = std::move(corners.passed);
  out.paths = std::move(paths);
  return out;
}

Result<DetourMotion, DetourFault> DetourPlanner::plan(const JointVec& q,
                                                      std::span<const JointVec> goals, double share,
                                                      const std::optional<double>& clearance) {
  if (!clearance && margin_ > 0) {
    Result<DetourMotion, DetourFault> found = plan(q, goals, share, margin_);
    if (found || is_stopped(stop_)) return found;
  }
  const Result<PlanningWorld*> here = world();
  if (!here) return no_detour("bad_input", here.error().what);
  PlanOptions search = kSearch;
  search.stop = stop_;
  search.clearance = clearance;
  Result<PlannedPath, WorldFailure> path = (*here)->plan(as_span(q), goals, search);
  if (!path) {
    const WorldFailure& why = path.error();
    const char* reason = why.code == WorldErrc::no_path ? name_of(why.search.code) : "bad_input";
    return no_detour(reason, why.what);
  }
  return timed({std::move(*path)}, share);
}

}  // namespace mjarm::program::detail
