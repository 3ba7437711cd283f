#include <iterator>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/plan_near.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/execution/path_motion.hpp"
#include "mjarm/planning/planning_world.hpp"

namespace mjarm::app {
namespace {

/// What mjarm did on one robot.
struct OurNearRuns {
  PlanRun joints{our_entry("mjarm", text(msg::bench_plan_near_joints), 0)};
  PlanRun poses{our_entry("mjarm", text(msg::bench_plan_near_poses), 0)};
  PlanRun first{our_entry("mjarm", text(msg::bench_plan_near_first), 0)};
};

Result<PlannedPath, WorldFailure> plan_near(PlanningWorld& world, const NearProblem& problem,
                                            const PlanOptions& options) {
  const std::span<const double> start = as_span(problem.start);
  if (problem.X_WT) return world.plan(start, *problem.X_WT, options);
  return world.plan(start, std::span(&problem.goal, 1), options);
}

/// How long the motion beside a path takes.
/// @return 0: an error.
double motion_time(const PlannedPath& path, const WayProver& prover, const JointLimits& limits) {
  const Result<PathMotion> motion = time_path(path.q, limits, prover);
  if (!motion) log_warning(motion.error().what);
  return motion ? motion->trajectory.duration() : 0;
}

void time_motions(PlanningWorld& world, const Arm& arm, const PlannedPath& path,
                  SolvedProblem& solved) {
  constexpr double kRamp = 1e-3;  // [s] in which accelerations may change where no jerk is limited
  const Result<WayProver> prover = world.prover({&path, 1});
  if (!prover) return log_warning(prover.error().what);
  solved.jerk_limited_s = motion_time(path, *prover, arm.limits);
  JointLimits limits = arm.limits;
  limits.jerk = limits.acceleration / kRamp;
  solved.motion_s = motion_time(path, *prover, limits);
}

/// @param with_motion  times motions as well, after the clock.
SolvedProblem solve_near(PlanningWorld& world, const NearSet& set, std::size_t index,
                         const PlanOptions& options, bool with_motion) {
  const NearProblem& problem = set.problems[index];
  SolvedProblem solved{.problem = index};
  const Stopwatch watch;
  const auto path = plan_near(world, problem, options);
  solved.us = watch.us();
  if (!path) {
    // The first plan of a scene is made twice: once it is told.
    if (with_motion)
      log_warning(text(msg::core_at_place, set.robot.name + ", " + problem.id, path.error().what));
    return solved;
  }
  for (const JointVec& q : path->q) solved.path.emplace_back(q.data(), q.data() + q.size());
  if (with_motion) time_motions(world, set.scenes[problem.scene].robot.arm, *path, solved);
  return solved;
}

/// From nothing to the first plan, then all problems of that scene in the world that is left.
/// @param first  index of its first problem; is moved to the next scene's.
Result<void> solve_near_scene(const NearSet& set, std::size_t& first, const PlanOptions& options,
                              OurNearRuns& ours) {
  const std::size_t index = set.problems[first].scene;
  const Stopwatch watch;
  const Result<Robot> robot = mjarm::load_robot(set.scenes[index].file.string(),
                                                {.tip = set.robot.tip, .load = {.looks = false}});
  if (!robot) return fail(robot.error());
  Result<PlanningWorld> world = PlanningWorld::create(*robot);
  if (!world) return fail(std::move(world.error()));
  const auto scene = world->scene();
  if (!scene) return fail(scene.error());
  const double world_us = watch.us();
  SolvedProblem once = solve_near(*world, set, first, options, false);
  once.us = watch.us();
  once.world_us = world_us;
  ours.first.answers.push_back(std::move(once));
  for (; first < set.problems.size() && set.problems[first].scene == index; ++first) {
    PlanRun& run = set.problems[first].X_WT ? ours.poses : ours.joints;
    run.answers.push_back(solve_near(*world, set, first, options, true));
  }
  return {};
}

Result<void> add_near_peers(const NearSet& set, const PlanPeers& peers, PlanTable& table) {
  if (!wants_peers(peers.environment.string(), set.robot.name)) return {};
  auto theirs = run_near_peers(set, peers);
  if (!theirs) return fail(std::move(theirs.error()));
  std::ranges::move(theirs->runs, std::back_inserter(table.runs));
  std::ranges::move(theirs->first, std::back_inserter(table.more));
  return {};
}

}  // namespace

Result<PlanTable> run_near_set(const NearSet& set, std::uint64_t seed, const PlanPeers& peers,
                               Progress& progress) {
  PlanTable table{.name = text(msg::bench_plan_near_name, set.robot.name),
                  .sum = true,
                  .complete = true,
                  .motions = true};
  for (const NearProblem& problem : set.problems) table.ids.push_back(problem.id);
  OurNearRuns ours;
  for (std::size_t first = 0; first < set.problems.size();) {
    auto done = solve_near_scene(set, first, {.seed = seed}, ours);
    if (!done) return fail(std::move(done.error()));
    progress.advance();
    if (interrupted()) return fail(stopped());
  }
  for (PlanRun* run : {&ours.joints, &ours.poses, &ours.first}) {
    // After all clocks.
    if (auto judged = judge_near_answers(set, run->answers); !judged) {
      return fail(std::move(judged.error()));
    }
    if (run->answers.empty()) continue;
    (run == &ours.first ? table.more : table.runs).push_back(std::move(*run));
  }
  if (auto done = add_near_peers(set, peers, table); !done) return fail(std::move(done.error()));
  return table;
}

}  // namespace mjarm::app
