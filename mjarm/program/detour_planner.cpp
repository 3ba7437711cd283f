#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/core/messages/program.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/path/joint_polyline.hpp"
#include "mjarm/program/detour_planner_internal.hpp"
#include "mjarm/trajectory/path_timing.hpp"

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
    case PlanErrc::budget_spent:
    case PlanErrc::unproved:
    case PlanErrc::not_available:
    case PlanErrc::back_end:
      return "no_path";
    case PlanErrc::start_tilted:
    case PlanErrc::goals_tilted:
      return "tilt";
    case PlanErrc::bad_tilt:
    case PlanErrc::tilt_with_ompl:
    case PlanErrc::bad_input:
      break;
  }
  return "bad_input";
}

/// The motion along the corners, each rounded within `blend` where it can be; rests at the others.
Result<Trajectory> time_corners(std::span<const JointVec> corners, double blend,
                                const JointLimits& limits) {
  constexpr double kSample = 0.05;  // [rad or m, L2]
  if (corners.size() == 1) return Trajectory::through({0.0}, {JointState::at_rest(corners[0])});
  const Result<JointPolyline> line = joint_polyline(corners, {.blend = blend, .step = kSample});
  if (!line) return fail(line.error());
  std::vector<Trajectory> parts;
  std::size_t first = 0;
  for (std::size_t i = 0; i < line->path.s.size(); ++i) {
    if (i == first || !std::ranges::binary_search(line->corners, line->path.s[i])) continue;
    const std::span<const JointVec> part(line->path.q.data() + first, i - first + 1);
    Result<Trajectory> trajectory = time_waypoint_path(part, limits);
    if (!trajectory) return trajectory;
    parts.push_back(std::move(*trajectory));
    first = i;
  }
  return Trajectory::chain(parts);
}

/// The shortest path that is found to the goals that are nearest, each by itself: to all at once
/// the first straight path that is free is taken, be it to the farthest.
void replace_by_shorter(const FastChecker& checker, const JointVec& q,
                        std::span<const JointVec> goals, const StopCheck& stop, PlannedPath& path) {
  constexpr std::size_t kMaxAlone = 8;
  PlanOptions search = kSearch;
  search.samples /= 10;
  search.stop = stop;
  std::vector<std::size_t> order(goals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto far = [&](std::size_t g) { return (goals[g] - q).norm(); };
  std::ranges::stable_sort(order, {}, far);
  for (std::size_t k = 0; k < std::min(order.size(), kMaxAlone); ++k) {
    const std::size_t g = order[k];
    if (far(g) >= path.cost) return;
    Result<PlannedPath, PlanFailure> other =
        plan_path(checker, as_span(q), goals.subspan(g, 1), search);
    if (!other || other->cost >= path.cost) continue;
    path = std::move(*other);
    path.goal = static_cast<int>(g);
  }
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

/// Whether the chords of the samples are free. Between two samples the motion leaves its chord by
/// less than 1e-5 rad, which the padding of the checker is for.
bool is_proved(const FastChecker& checker, const std::vector<JointVec>& way) {
  for (std::size_t i = 1; i < way.size(); ++i) {
    const EdgeResult edge = check_edge(checker, as_span(way[i - 1]), as_span(way[i]), {1e-5});
    if (edge.verdict != EdgeVerdict::free) return false;
  }
  return true;
}

std::vector<JointVec> without_repeats(std::vector<JointVec> corners) {
  constexpr double kSame = 1e-9;
  const auto same = [](const JointVec& a, const JointVec& b) { return (a - b).norm() < kSame; };
  corners.erase(std::unique(corners.begin(), corners.end(), same), corners.end());
  return corners;
}

tl::unexpected<DetourFault> no_detour(std::string reason, std::string what) {
  return tl::unexpected(DetourFault{std::move(reason), std::move(what)});
}

}  // namespace

std::optional<std::string> DetourPlanner::touches(const JointVec& q) const {
  return MoveJudge::touches(judge_.measure(ik_, {q}));
}

std::optional<std::string> DetourPlanner::least_touch(const JointVec& q, const Pose& X_WT) const {
  const auto answers = solve_all(IkSolver(robot_.arm, {.task = ik_.options().task}), X_WT,
                                 as_span(q), {.max = kMaxGoals});
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

/// Times the path with the widest rounding of its corners that is proved free.
Result<DetourMotion, DetourFault> DetourPlanner::timed(const FastChecker& checker,
                                                       const std::vector<JointVec>& path,
                                                       const JointLimits& limits) const {
  DetourMotion out;
  out.corners = without_repeats(path);
  std::vector<JointVec> way;
  for (const double blend : {0.4, 0.2, 0.1, 0.05, 0.0}) {
    Result<Trajectory> trajectory = time_corners(out.corners, blend, limits);
    if (!trajectory) return no_detour("timing", trajectory.error().what);
    way = sampled(*trajectory, limits);
    if (blend > 0 && !is_proved(checker, way)) continue;
    out.trajectory = std::move(*trajectory);
    break;
  }
  out.measures = judge_.measure(ik_, way);
  if (const auto pair = MoveJudge::touches(out.measures)) {
    return no_detour("collision", text(msg::program_move_touches, *pair));
  }
  return out;
}

Result<DetourMotion, DetourFault> DetourPlanner::plan(const JointVec& q,
                                                      std::span<const JointVec> goals,
                                                      double share) {
  if (options_.margin > 0) {
    WorldOptions wide = options_;
    wide.bounds.resize(1);  // what finer spheres are needed for has no room for a margin
    Result<DetourMotion, DetourFault> found = plan_in(wide_, wide, q, goals, share);
    if (found || is_stopped(stop_)) return found;
  }
  WorldOptions tight = options_;
  tight.margin = 0;
  return plan_in(tight_, tight, q, goals, share);
}

/// @param world  of `options`; made when it is needed first.
Result<DetourMotion, DetourFault> DetourPlanner::plan_in(std::optional<PlanningWorld>& world,
                                                         const WorldOptions& options,
                                                         const JointVec& q,
                                                         std::span<const JointVec> goals,
                                                         double share) {
  JointLimits limits = robot_.arm.limits;
  limits.velocity *= share;
  limits.acceleration *= share;
  if (!world) {
    Result<PlanningWorld> made = PlanningWorld::create(robot_, options);
    if (!made) return no_detour("bad_input", made.error().what);
    world = std::move(*made);
  }
  PlanOptions search = kSearch;
  search.stop = stop_;
  Result<WorldPath, WorldFailure> path = world->plan(as_span(q), goals, search);
  if (!path) {
    const WorldFailure& why = path.error();
    const char* reason = why.code == WorldErrc::no_path ? name_of(why.search.code) : "bad_input";
    return no_detour(reason,
                     why.what + (why.bound > 0 ? text(msg::program_spheres, 1e3 * why.bound) : ""));
  }
  const FastChecker& checker = (*world->level(path->level))->checker;
  if (goals.size() > 1) replace_by_shorter(checker, q, goals, stop_, *path);
  Result<DetourMotion, DetourFault> motion = timed(checker, path->q, limits);
  if (motion) motion->goal = static_cast<std::size_t>(path->goal);
  return motion;
}

}  // namespace mjarm::program::detail
