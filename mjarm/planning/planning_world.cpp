#include "mjarm/planning/planning_world.hpp"

#include <algorithm>
#include <utility>

#include "mjarm/core/messages/planning.hpp"

namespace mjarm {
namespace {

/// Whether finer spheres may do better.
bool is_coarse(PlanErrc reason) {
  return reason == PlanErrc::start_hit || reason == PlanErrc::goals_hit ||
         reason == PlanErrc::goals_tilted || reason == PlanErrc::base_hit ||
         reason == PlanErrc::budget_spent;
}

Result<void> check_world_options(const WorldOptions& options) {
  if (!(options.margin >= 0 && options.margin <= kMaxMargin)) {
    return fail(Errc::bad_input, text(msg::planning_bad_margin, options.margin, kMaxMargin));
  }
  const auto fits = [](double b) { return b >= kMinSphereBound && b <= kMaxSphereBound; };
  if (!options.bounds.empty() && std::ranges::all_of(options.bounds, fits)) return {};
  return fail(Errc::bad_input, text(msg::planning_bad_bounds, kMinSphereBound, kMaxSphereBound));
}

/// plan_path() as an attempt at one level.
Result<PlannedPath, WorldFailure> search(const FastChecker& checker,
                                         std::span<const double> q_start,
                                         std::span<const JointVec> goals,
                                         const PlanOptions& options, PlanTimes* times) {
  return plan_path(checker, q_start, goals, options, times).map_error([](const PlanFailure& why) {
    return WorldFailure{.what = {}, .search = why};
  });
}

WorldFailure not_found(const PlanFailure& search, const WorldLevel& level, std::size_t index) {
  return {.code = WorldErrc::no_path,
          .what = describe(search, level.checker.robot(), level.cover.scene),
          .search = search,
          .level = index,
          .bound = is_coarse(search.code) ? level.cover.bound : 0};
}

}  // namespace

Result<PlanningWorld> PlanningWorld::create(const Robot& robot, WorldOptions options) {
  if (Result<void> fine = check_world_options(options); !fine) return fail(fine.error());
  Result<void> fine = check_contact_rules(robot.model, robot.arm, options.rules);
  if (!fine) return fail(std::move(fine.error()));
  return PlanningWorld(robot, std::move(options));
}

Result<WorldLevel> PlanningWorld::covered(double bound, const StopCheck& stop) const {
  const CoverOptions options{.bound = bound,
                             .qpos = options_.qpos,
                             .whole_stroke = robot_.arm.gripper && options_.qpos.empty(),
                             .rules = options_.rules,
                             .stop = stop};
  Result<ModelCover> cover = cover_model(robot_.model, robot_.arm, options);
  if (!cover) return fail(std::move(cover.error()));
  for (LinkSpheres& link : cover->spheres.links) {
    for (Sphere& sphere : link.spheres) sphere.radius += options_.margin;
  }
  const Result<FastRobot> fast = FastRobot::create(robot_.arm, cover->spheres);
  if (!fast) return fail(fast.error());
  Result<FastChecker> checker = FastChecker::create(*fast, cover->scene);
  if (!checker) return fail(std::move(checker.error()));
  return WorldLevel{bound, std::move(*cover), std::move(*checker)};
}

Result<const WorldLevel*> PlanningWorld::level(std::size_t index, const StopCheck& stop) {
  if (index >= options_.bounds.size()) {
    return fail(Errc::bad_input, text(msg::planning_no_level, index, options_.bounds.size()));
  }
  while (levels_.size() <= index) {
    Result<WorldLevel> made = covered(options_.bounds[levels_.size()], stop);
    if (!made) return fail(std::move(made.error()));
    levels_.push_back(std::move(*made));
  }
  return &levels_[index];
}

/// One level after the other, until there is a path or finer spheres are no help.
/// @param attempt  gets a checker; gives a path or a failure whose words and level are filled in
/// here, where it is one of a search.
template <class Attempt>
Result<WorldPath, WorldFailure> PlanningWorld::climb(const StopCheck& stop,
                                                     const Attempt& attempt) {
  WorldFailure why;
  for (std::size_t i = 0; i < options_.bounds.size(); ++i) {
    const Result<const WorldLevel*> here = level(i, stop);
    if (!here && is_stopped(stop)) {
      return tl::unexpected(WorldFailure{
          .what = here.error().what, .search = {.code = PlanErrc::stopped}, .level = i});
    }
    if (!here) return tl::unexpected(WorldFailure{WorldErrc::bad_model, here.error().what});
    Result<PlannedPath, WorldFailure> found = attempt((*here)->checker);
    if (found) return WorldPath{std::move(*found), i};
    if (found.error().code != WorldErrc::no_path) return tl::unexpected(std::move(found.error()));
    why = not_found(found.error().search, **here, i);
    if (why.bound == 0) break;
  }
  return tl::unexpected(std::move(why));
}

Result<WorldPath, WorldFailure> PlanningWorld::plan(std::span<const double> q_start,
                                                    std::span<const JointVec> goals,
                                                    const PlanOptions& options, PlanTimes* times) {
  return climb(options.stop, [&](const FastChecker& checker) {
    return search(checker, q_start, goals, options, times);
  });
}

Result<WorldPath, WorldFailure> PlanningWorld::plan(std::span<const double> q_start,
                                                    const GoalRegion& region,
                                                    const PlanOptions& options, IkTask task,
                                                    PlanTimes* times) {
  return climb(options.stop, [&](const FastChecker& checker) -> Result<PlannedPath, WorldFailure> {
    const IkSolver ik(robot_.arm, {.seed = options.seed, .task = task});
    const auto goals = goals_in(checker, ik, region, q_start,
                                {.seed = options.seed, .tilt = options.tilt, .stop = options.stop});
    if (!goals) {
      return tl::unexpected(
          WorldFailure{WorldErrc::no_answer, describe(goals.error(), robot_.arm)});
    }
    return search(checker, q_start, *goals, options, times);
  });
}

}  // namespace mjarm
