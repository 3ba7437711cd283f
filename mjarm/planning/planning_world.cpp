#include "mjarm/planning/planning_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "mjarm/core/messages/planning.hpp"
#include "mjarm/kinematics/chain.hpp"
#include "mjarm/planning/clear_path_internal.hpp"
#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/world_search_internal.hpp"

namespace mjarm {
namespace {

constexpr int kPreferSamples = 3000;  // of each search with a clearance that nobody asked for
constexpr int kAloneSamples = 2000;   // of a search to one goal, once there is a path to another
// [m] Coarse: what it costs to make finer ones is more than a plan takes that looks closer.
constexpr double kSphereBound = 0.02;
constexpr int kSphereSamples = 2000;  // of a search among spheres alone

/// Whether there may be a path all the same where one looks closer than spheres do.
bool may_be_spheres(PlanErrc reason) {
  return reason == PlanErrc::start_hit || reason == PlanErrc::goals_hit ||
         reason == PlanErrc::goals_tilted || reason == PlanErrc::goals_off ||
         reason == PlanErrc::base_hit || reason == PlanErrc::budget_spent ||
         reason == PlanErrc::too_near || reason == PlanErrc::unproved;
}

Result<void> check_world_options(const WorldOptions& options) {
  if (!(options.margin >= 0 && options.margin <= kMaxMargin)) {
    return fail(Errc::bad_input, text(msg::planning_bad_margin, options.margin, kMaxMargin));
  }
  return {};
}

/// The goals that are tried alone: those nearest to the start.
std::vector<std::size_t> nearest_goals(std::span<const double> q_start,
                                       std::span<const JointVec> goals) {
  constexpr std::size_t kMaxAlone = 8;
  const JointVec start = joint_vec(q_start);
  std::vector<std::size_t> order(goals.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t g) { return (goals[g] - start).norm(); });
  order.resize(std::min(order.size(), kMaxAlone));
  return order;
}

/// To all goals at once the first straight way that is free is taken, be it to the farthest. So the
/// nearest ones are tried alone, and the shortest path is kept.
/// @param left  of PlanOptions::time_limit.
/// @param plan  plan(goals, options): a path to one of them, or why there is none.
template <class Plan>
void try_goals_alone(std::span<const double> q_start, std::span<const JointVec> goals,
                     const PlanOptions& options, const detail::TimeLeft& left, const Plan& plan,
                     PlannedPath& path) {
  PlanOptions search = options;
  search.samples = detail::least_samples(options, kAloneSamples);
  search.time_budget = 0;
  search.enclosure = nullptr;
  for (const std::size_t g : nearest_goals(q_start, goals)) {
    const double far = (goals[g] - joint_vec(q_start)).norm();
    if (far >= path.cost || left.none() || is_stopped(options.stop)) return;
    Result<PlannedPath, PlanFailure> other = plan(goals.subspan(g, 1), left.in(search));
    if (!other || other->cost >= path.cost) continue;
    path = std::move(*other);
    path.goal = static_cast<int>(g);
  }
}

/// Whether spheres leave out none of the goals that a short path may lead to.
bool are_free(const FastChecker& spheres, std::span<const double> q_start,
              std::span<const JointVec> goals) {
  const auto sizes_fit = [&](const JointVec& q) { return as_span(q).size() == q_start.size(); };
  if (!std::ranges::all_of(goals, sizes_fit)) return true;  // the search says what is wrong
  return std::ranges::all_of(nearest_goals(q_start, goals),
                             [&](std::size_t g) { return spheres.is_free(as_span(goals[g])); });
}

WorldFailure bad_clearance(double asked) {
  return {.code = WorldErrc::no_path,
          .what = text(msg::planning_bad_clearance, asked, kMaxClearanceAsked),
          .search = {.code = PlanErrc::bad_clearance, .limit = asked}};
}

WorldFailure not_found(PlanFailure search, const PlanOptions& options, const WorldScene& scene) {
  if (search.code == PlanErrc::out_of_time) search.limit = options.time_limit;
  return {.code = WorldErrc::no_path,
          .what = describe(search, scene.checker.robot(), scene.cover.scene),
          .search = search};
}

}  // namespace

namespace detail {

Result<PlannedPath, WorldFailure> search_scene(const ClearScene& scene, ClearEnds ends,
                                               std::span<const double> q_start,
                                               std::span<const JointVec> goals,
                                               const PlanOptions& options, PlanTimes* times) {
  const bool is_sphere_scene = !scene.checker.solids();
  if (goals.size() > 1 && is_sphere_scene && !are_free(scene.checker, q_start, goals)) {
    return tl::unexpected(WorldFailure{.what = {}, .search = {.code = PlanErrc::goals_hit}});
  }
  const TimeLeft left(options);
  const bool clear = options.clearance.value_or(0) > 0;
  const auto plan = [&](std::span<const JointVec> to, const PlanOptions& with) {
    PlanTimes taken;
    auto path = clear ? plan_clear(scene, q_start, to, with, ends, &taken)
                      : plan_path(scene.checker, q_start, to, with, &taken);
    if (times != nullptr) {
      times->search_us += taken.search_us;
      times->finish_us += taken.finish_us;
    }
    return path;
  };
  Result<PlannedPath, PlanFailure> found = plan(goals, options);
  if (found && goals.size() > 1) try_goals_alone(q_start, goals, options, left, plan, *found);
  return std::move(found).map_error(
      [](const PlanFailure& why) { return WorldFailure{.what = {}, .search = why}; });
}

}  // namespace detail

Result<PlanningWorld> PlanningWorld::create(const Robot& robot, WorldOptions options) {
  if (Result<void> fine = check_world_options(options); !fine) return fail(fine.error());
  Result<void> fine = check_contact_rules(robot.model, robot.arm, options.rules);
  if (!fine) return fail(std::move(fine.error()));
  return PlanningWorld(robot, std::move(options));
}

Result<WorldScene> PlanningWorld::covered(const StopCheck& stop) const {
  const CoverOptions options{
      .bound = kSphereBound, .qpos = options_.qpos, .rules = options_.rules, .stop = stop};
  Result<ModelCover> cover = cover_model(robot_.model, robot_.arm, options);
  if (!cover) return fail(std::move(cover.error()));
  const SphereMargins margins{options_.margin, 2 * options_.margin};
  const Result<FastRobot> fast = FastRobot::create(robot_.arm, cover->spheres, margins);
  if (!fast) return fail(fast.error());
  Result<FastChecker> checker = FastChecker::create(*fast, cover->scene);
  if (!checker) return fail(std::move(checker.error()));
  FastChecker closer = checker->looking_closer(cover->solids);
  return WorldScene{std::move(*cover), std::move(closer)};
}

Result<const WorldScene*> PlanningWorld::scene(const StopCheck& stop) {
  if (!scene_) {
    Result<WorldScene> made = covered(stop);
    if (!made) return fail(std::move(made.error()));
    scene_ = std::make_shared<const WorldScene>(std::move(*made));
  }
  return scene_.get();
}

/// Among spheres alone, and looking closer where they may be what is in the way.
/// @param attempt  gets a scene, what may be nearer than a clearance and the options; gives a path
/// or a failure whose words are filled in here, where it is one of a search.
template <class Attempt>
Result<PlannedPath, WorldFailure> PlanningWorld::spheres_then_solids(const PlanOptions& options,
                                                                     detail::TimeLeft& left,
                                                                     const Attempt& attempt) {
  const Stopwatch covering;
  const Result<const WorldScene*> here = scene(options.stop);
  left.add(covering.us());
  if (!here && is_stopped(options.stop)) {
    return tl::unexpected(
        WorldFailure{.what = here.error().what, .search = {.code = PlanErrc::stopped}});
  }
  if (!here) return tl::unexpected(WorldFailure{WorldErrc::bad_model, here.error().what});
  const FastChecker& closer = (*here)->checker;
  const FastChecker spheres = closer.looking_closer(nullptr);
  PlanOptions quick = options;
  quick.samples = detail::least_samples(options, kSphereSamples);
  // Start and goal that spheres call too near may keep what is asked all the same.
  Result<PlannedPath, WorldFailure> found =
      attempt(detail::ClearScene{spheres, (*here)->cover.scene, &wide_spheres_},
              detail::ClearEnds::also, left.in(quick));
  if (found) detail::measure_edges(closer, *found);
  const auto is_of_search = [&] { return !found && found.error().code == WorldErrc::no_path; };
  if (is_of_search() && may_be_spheres(found.error().search.code)) {
    found = attempt(detail::ClearScene{closer, (*here)->cover.scene, &wide_},
                    detail::ClearEnds::own, left.in(options));
  }
  if (is_of_search()) found = tl::unexpected(not_found(found.error().search, options, **here));
  return found;
}

/// spheres_then_solids() with the clearance that is asked, or with the one that is preferred and
/// without.
template <class Attempt>
Result<PlannedPath, WorldFailure> PlanningWorld::keep_clearance(const PlanOptions& options,
                                                                const Attempt& attempt) {
  detail::TimeLeft left(options);
  PlanOptions bare = options;
  bare.clearance = 0;
  if (options.clearance == 0) return spheres_then_solids(bare, left, attempt);
  if (!detail::is_sound_clearance(options.clearance)) {
    return tl::unexpected(bad_clearance(*options.clearance));
  }
  PlanOptions clear = options;
  if (!options.clearance) {
    clear.clearance = kPreferredClearance;
    clear.samples = detail::least_samples(options, kPreferSamples);
    Result<PlannedPath, WorldFailure> found = spheres_then_solids(clear, left, attempt);
    const bool decided = found || is_stopped(options.stop) || is_proof(found.error().search.code);
    return decided ? std::move(found) : spheres_then_solids(bare, left, attempt);
  }
  Result<PlannedPath, WorldFailure> found = spheres_then_solids(clear, left, attempt);
  if (found || found.error().code != WorldErrc::no_path ||
      !detail::is_for_clearance(found.error().search)) {
    return found;
  }
  PlanOptions quick = bare;
  quick.rounds = 0;
  quick.time_budget = 0;
  if (auto any = spheres_then_solids(quick, left, attempt); !any) return any;
  const double possible = detail::largest_clearance(clear, [&](const PlanOptions& less) {
    return spheres_then_solids(less, left, attempt).has_value();
  });
  if (is_stopped(options.stop)) return found;
  return tl::unexpected(
      not_found(detail::too_near(*options.clearance, possible), options, *scene_));
}

Result<WayProver> PlanningWorld::prover(std::span<const PlannedPath> paths, const StopCheck& stop) {
  constexpr double kBeside = 1.2;  // of the length of an edge, as a way need not be on it
  double clearance = kMaxClearanceAsked;
  for (const PlannedPath& path : paths) clearance = std::min(clearance, path.clearance);
  const Result<const WorldScene*> here = scene(stop);
  if (!here) return fail(here.error());
  const detail::ClearScene within{(*here)->checker, (*here)->cover.scene, &wide_};
  const FastChecker wide = detail::checker_with(within, std::max(clearance, WayProver::kSpare));
  std::vector<WayProver::NearEnd> ends;
  for (const PlannedPath& path : paths) {
    const std::size_t last = path.q.size() - 1;
    for (const auto& [end, next, edge] :
         {std::array<std::size_t, 3>{0, 1, 0}, {last, last - 1, last - 1}}) {
      if (path.kept.empty() || !(path.kept[edge] < clearance)) continue;
      const double kept = std::max(path.kept[edge], WayProver::kSpare);
      ends.push_back({path.q[end], kBeside * (path.q[next] - path.q[end]).norm(),
                      detail::checker_within(within, wide, kept)});
    }
  }
  return WayProver(wide, std::move(ends));
}

/// `options` with a test of all goals, in exact geometry, whatever is searched in.
/// @param test  of the request, made when it is asked for first.
PlanOptions PlanningWorld::testing(std::optional<EnclosureTest>& test,
                                   std::span<const double> q_start, std::span<const JointVec> goals,
                                   const PlanOptions& options) const {
  if (!test) test.emplace(scene_->checker, scene_->cover.scene, q_start, goals);
  PlanOptions out = options;
  out.enclosure = &*test;
  return out;
}

/// A joint goal may be in a winding to which no way leads, while one leads to the same posture.
void PlanningWorld::tell_winding(std::span<const double> q_start, const JointVec& goal,
                                 const PlanOptions& options, WorldFailure& why) {
  const Chain chain(robot_.arm);
  const JointVec same = unwind(chain, goal, joint_vec(q_start));
  if ((same - goal).norm() < 1) return;
  PlanOptions quick = options;
  quick.samples = detail::least_samples(options, kSphereSamples);
  quick.rounds = 0;
  quick.time_budget = 0;
  const std::vector<JointVec> goals{same};
  if (!plan(q_start, goals, quick)) return;
  why.same_posture = same;
  why.what +=
      text(msg::planning_same_posture, fmt::format("{:.6g}", fmt::join(as_span(same), ",")));
}

Result<PlannedPath, WorldFailure> PlanningWorld::plan(std::span<const double> q_start,
                                                      std::span<const JointVec> goals,
                                                      const PlanOptions& options,
                                                      PlanTimes* times) {
  std::optional<EnclosureTest> enclosure;
  Result<PlannedPath, WorldFailure> found = keep_clearance(
      options,
      [&](const detail::ClearScene& scene, detail::ClearEnds ends, const PlanOptions& how) {
        return detail::search_scene(scene, ends, q_start, goals,
                                    testing(enclosure, q_start, goals, how), times);
      });
  const auto is_for_winding = [](PlanErrc code) {
    return code == PlanErrc::barred || code == PlanErrc::budget_spent ||
           code == PlanErrc::out_of_time;
  };
  if (!found && goals.size() == 1 && is_for_winding(found.error().search.code)) {
    tell_winding(q_start, goals.front(), options, found.error());
  }
  return found;
}

Result<detail::EndConfigurations, WorldFailure> PlanningWorld::configurations(
    const PathEnd& end, std::span<const double> q_near, const PlanOptions& options) const {
  if (end.regions.empty()) return detail::EndConfigurations(end.q);
  const IkSolver ik(robot_.arm, {.seed = options.seed, .task = end.task});
  auto found = RegionGoals::create(
      scene_->checker, ik, end.regions, q_near,
      {.seed = options.seed, .tilt = options.tilt, .within = options.within, .stop = options.stop});
  if (found) return detail::EndConfigurations(std::move(*found));
  std::string why = describe(found.error(), robot_.arm);
  if (end.regions.size() > 1) why = text(msg::planning_no_region, end.regions.size(), why);
  return tl::unexpected(WorldFailure{WorldErrc::no_answer, std::move(why)});
}

Result<PlannedPath, WorldFailure> PlanningWorld::plan(const PathEnd& start, const PathEnd& goal,
                                                      const PlanOptions& options,
                                                      PlanTimes* times) {
  using Ends = Result<detail::EndConfigurations, WorldFailure>;
  std::optional<Ends> starts, goals;  // once there is a scene
  std::optional<EnclosureTest> enclosure;
  const auto attempt = [&](const detail::ClearScene& scene, detail::ClearEnds ends,
                           const PlanOptions& how) -> Result<PlannedPath, WorldFailure> {
    if (!starts) {
      starts = configurations(start, as_span(robot_.arm.home), how);
      if (*starts && (*starts)->q().empty()) *starts = detail::EndConfigurations({JointVec()});
      if (*starts) goals = configurations(goal, as_span((*starts)->q().front()), how);
    }
    if (!*starts) {
      WorldFailure why = starts->error();
      why.what = text(msg::planning_start_region, why.what);
      return tl::unexpected(std::move(why));
    }
    if (!*goals) return tl::unexpected(goals->error());
    // Of all that a path may lead to, which is not known as long as more may be drawn.
    const bool is_all =
        (*starts)->q().size() == 1 && !(*starts)->may_draw() && !(*goals)->may_draw();
    const PlanOptions tested =
        is_all ? testing(enclosure, as_span((*starts)->q().front()), (*goals)->q(), how) : how;
    return detail::search_between(scene, ends, **starts, **goals, tested, times);
  };
  return keep_clearance(options, attempt);
}

}  // namespace mjarm
