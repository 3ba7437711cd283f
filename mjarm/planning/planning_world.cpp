#include "mjarm/planning/planning_world.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "mjarm/core/messages/planning.hpp"
#include "mjarm/planning/clear_path_internal.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm {
namespace {

constexpr int kPreferSamples = 3000;  // of each search with a clearance that nobody asked for
constexpr int kAloneSamples = 2000;   // of a search to one goal, once there is a path to another
constexpr int kCoarseSamples = 5000;  // of a search with a clearance where finer spheres are left

/// Whether finer spheres may do better.
bool is_coarse(PlanErrc reason) {
  return reason == PlanErrc::start_hit || reason == PlanErrc::goals_hit ||
         reason == PlanErrc::goals_tilted || reason == PlanErrc::base_hit ||
         reason == PlanErrc::budget_spent || reason == PlanErrc::too_near;
}

int least_samples(const PlanOptions& options, int max) {
  return options.samples > 0 ? std::min(options.samples, max) : max;
}

Result<void> check_world_options(const WorldOptions& options) {
  if (!(options.margin >= 0 && options.margin <= kMaxMargin)) {
    return fail(Errc::bad_input, text(msg::planning_bad_margin, options.margin, kMaxMargin));
  }
  const auto fits = [](double b) { return b >= kMinSphereBound && b <= kMaxSphereBound; };
  if (!options.bounds.empty() && std::ranges::all_of(options.bounds, fits)) return {};
  return fail(Errc::bad_input, text(msg::planning_bad_bounds, kMinSphereBound, kMaxSphereBound));
}

/// To all goals at once the first straight way that is free is taken, be it to the farthest. So the
/// nearest ones are tried alone, and the shortest path is kept.
/// @param left  of PlanOptions::time_limit.
/// @param plan  plan(goals, options): a path to one of them, or why there is none.
template <class Plan>
void try_goals_alone(std::span<const double> q_start, std::span<const JointVec> goals,
                     const PlanOptions& options, const detail::TimeLeft& left, const Plan& plan,
                     PlannedPath& path) {
  constexpr std::size_t kMaxAlone = 8;
  PlanOptions search = options;
  search.samples = least_samples(options, kAloneSamples);
  search.time_budget = 0;
  const JointVec start = joint_vec(q_start);
  std::vector<std::size_t> order(goals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto far = [&](std::size_t g) { return (goals[g] - start).norm(); };
  std::ranges::stable_sort(order, {}, far);
  for (std::size_t k = 0; k < std::min(order.size(), kMaxAlone); ++k) {
    const std::size_t g = order[k];
    if (far(g) >= path.cost || left.none() || is_stopped(options.stop)) return;
    Result<PlannedPath, PlanFailure> other = plan(goals.subspan(g, 1), left.in(search));
    if (!other || other->cost >= path.cost) continue;
    path = std::move(*other);
    path.goal = static_cast<int>(g);
  }
}

/// One search at one level, for a clearance where one is asked.
/// @param ends  what may be nearer.
Result<PlannedPath, WorldFailure> search(const detail::ClearScene& scene, detail::ClearEnds ends,
                                         std::span<const double> q_start,
                                         std::span<const JointVec> goals,
                                         const PlanOptions& options, PlanTimes* times) {
  const detail::TimeLeft left(options);
  PlanOptions how = options;
  const bool clear = options.clearance.value_or(0) > 0;
  if (clear && ends == detail::ClearEnds::also)
    how.samples = least_samples(options, kCoarseSamples);
  const auto plan = [&](std::span<const JointVec> to, const PlanOptions& with) {
    PlanTimes taken;
    auto path = clear ? detail::plan_clear(scene, q_start, to, with, ends, &taken)
                      : plan_path(scene.checker, q_start, to, with, &taken);
    if (times != nullptr) {
      times->search_us += taken.search_us;
      times->finish_us += taken.finish_us;
    }
    return path;
  };
  Result<PlannedPath, PlanFailure> found = plan(goals, how);
  if (found && goals.size() > 1) try_goals_alone(q_start, goals, how, left, plan, *found);
  return std::move(found).map_error(
      [](const PlanFailure& why) { return WorldFailure{.what = {}, .search = why}; });
}

WorldFailure bad_clearance(double asked) {
  return {.code = WorldErrc::no_path,
          .what = text(msg::planning_bad_clearance, asked, kMaxClearanceAsked),
          .search = {.code = PlanErrc::bad_clearance, .limit = asked}};
}

WorldFailure not_found(PlanFailure search, const PlanOptions& options, const WorldLevel& level,
                       std::size_t index) {
  if (search.code == PlanErrc::out_of_time) search.limit = options.time_limit;
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
    wide_.emplace_back();
  }
  return &levels_[index];
}

/// One level after the other, until there is a path or finer spheres are no help.
/// @param attempt  gets a scene, what may be nearer than a clearance and the options; gives a path
/// or a failure whose words and level are filled in here, where it is one of a search.
template <class Attempt>
Result<WorldPath, WorldFailure> PlanningWorld::climb(const PlanOptions& options,
                                                     detail::TimeLeft& left, Ask ask,
                                                     const Attempt& attempt) {
  WorldFailure why;
  for (std::size_t i = 0; i < options_.bounds.size(); ++i) {
    const Stopwatch covering;
    const Result<const WorldLevel*> here = level(i, options.stop);
    left.add(covering.us());
    if (!here && is_stopped(options.stop)) {
      return tl::unexpected(WorldFailure{
          .what = here.error().what, .search = {.code = PlanErrc::stopped}, .level = i});
    }
    if (!here) return tl::unexpected(WorldFailure{WorldErrc::bad_model, here.error().what});
    // Start and goal that coarse spheres call too near may keep what is asked all the same.
    const bool strict = ask == Ask::required && i + 1 < options_.bounds.size();
    const auto ends = strict ? detail::ClearEnds::also : detail::ClearEnds::own;
    Result<PlannedPath, WorldFailure> found =
        attempt(detail::ClearScene{(*here)->checker, (*here)->cover.scene, &wide_[i]}, ends,
                left.in(options));
    if (found) return WorldPath{std::move(*found), i};
    if (found.error().code != WorldErrc::no_path) return tl::unexpected(std::move(found.error()));
    why = not_found(found.error().search, options, **here, i);
    if (why.bound == 0) break;
  }
  return tl::unexpected(std::move(why));
}

/// climb() with the clearance that is asked, or with the one that is preferred and without.
template <class Attempt>
Result<WorldPath, WorldFailure> PlanningWorld::keep_clearance(const PlanOptions& options,
                                                              const Attempt& attempt) {
  detail::TimeLeft left(options);
  PlanOptions bare = options;
  bare.clearance = 0;
  if (options.clearance == 0) return climb(bare, left, Ask::preferred, attempt);
  if (!detail::is_sound_clearance(options.clearance)) {
    return tl::unexpected(bad_clearance(*options.clearance));
  }
  PlanOptions clear = options;
  if (!options.clearance) {
    clear.clearance = kPreferredClearance;
    clear.samples = least_samples(options, kPreferSamples);
    Result<WorldPath, WorldFailure> found = climb(clear, left, Ask::preferred, attempt);
    const bool decided = found || is_stopped(options.stop);
    return decided ? std::move(found) : climb(bare, left, Ask::preferred, attempt);
  }
  Result<WorldPath, WorldFailure> found = climb(clear, left, Ask::required, attempt);
  if (found || found.error().code != WorldErrc::no_path ||
      !detail::is_for_clearance(found.error().search)) {
    return found;
  }
  PlanOptions quick = bare;
  quick.rounds = 0;
  quick.time_budget = 0;
  if (auto any = climb(quick, left, Ask::required, attempt); !any) return any;
  const double possible = detail::largest_clearance(clear, [&](const PlanOptions& less) {
    return climb(less, left, Ask::required, attempt).has_value();
  });
  if (is_stopped(options.stop)) return found;
  const std::size_t at = found.error().level;
  return tl::unexpected(
      not_found(detail::too_near(*options.clearance, possible), options, levels_[at], at));
}

Result<WayProver> PlanningWorld::prover(std::span<const WorldPath> paths, const StopCheck& stop) {
  constexpr double kBeside = 1.2;  // of the length of an edge, as a way need not be on it
  std::size_t finest = 0;
  double clearance = kMaxClearanceAsked;
  for (const WorldPath& path : paths) {
    finest = std::max(finest, path.level);
    clearance = std::min(clearance, path.clearance);
  }
  const Result<const WorldLevel*> here = level(finest, stop);
  if (!here) return fail(here.error());
  const detail::ClearScene scene{(*here)->checker, (*here)->cover.scene, &wide_[finest]};
  std::vector<WayProver::NearEnd> ends;
  for (const WorldPath& path : paths) {
    const std::size_t last = path.q.size() - 1;
    for (const auto& [end, next, edge] :
         {std::array<std::size_t, 3>{0, 1, 0}, {last, last - 1, last - 1}}) {
      if (path.kept.empty() || !(path.kept[edge] < clearance)) continue;
      const double kept = std::max(path.kept[edge], WayProver::kSpare);
      ends.push_back({path.q[end], kBeside * (path.q[next] - path.q[end]).norm(),
                      detail::checker_with(scene, kept)});
    }
  }
  return WayProver(detail::checker_with(scene, std::max(clearance, WayProver::kSpare)),
                   std::move(ends));
}

Result<WorldPath, WorldFailure> PlanningWorld::plan(std::span<const double> q_start,
                                                    std::span<const JointVec> goals,
                                                    const PlanOptions& options, PlanTimes* times) {
  return keep_clearance(options, [&](const detail::ClearScene& scene, detail::ClearEnds ends,
                                     const PlanOptions& how) {
    return search(scene, ends, q_start, goals, how, times);
  });
}

Result<WorldPath, WorldFailure> PlanningWorld::plan(std::span<const double> q_start,
                                                    const GoalRegion& region,
                                                    const PlanOptions& options, IkTask task,
                                                    PlanTimes* times) {
  return keep_clearance(options,
                        [&](const detail::ClearScene& scene, detail::ClearEnds ends,
                            const PlanOptions& how) -> Result<PlannedPath, WorldFailure> {
                          const IkSolver ik(robot_.arm, {.seed = how.seed, .task = task});
                          const auto goals =
                              goals_in(scene.checker, ik, region, q_start,
                                       {.seed = how.seed, .tilt = how.tilt, .stop = how.stop});
                          if (!goals) {
                            return tl::unexpected(WorldFailure{
                                WorldErrc::no_answer, describe(goals.error(), robot_.arm)});
                          }
                          return search(scene, ends, q_start, *goals, how, times);
                        });
}

}  // namespace mjarm
