#include <algorithm>
#include <numeric>
#include <utility>

#include "mjarm/planning/search_internal.hpp"
#include "mjarm/planning/world_search_internal.hpp"

namespace mjarm::detail {
namespace {

using Found = Result<PlannedPath, WorldFailure>;

constexpr int kFirstRound = 2000;       // samples before more goals are drawn
constexpr int kEndPulls = 3;            // of the ends of a path,
constexpr double kPullPaysPath = 0.01;  // each as long as it saves this share
constexpr std::size_t kMaxStarts = 8;   // that are tried, those nearest to a goal

/// Whether there may be a path between others that stand for the same regions.
bool may_be_others(PlanErrc reason) {
  return reason == PlanErrc::start_hit || reason == PlanErrc::start_tilted ||
         reason == PlanErrc::start_off || reason == PlanErrc::goals_hit ||
         reason == PlanErrc::goals_tilted || reason == PlanErrc::goals_off ||
         reason == PlanErrc::budget_spent;
}

int all_samples(const PlanOptions& options) {
  if (options.samples > 0) return options.samples;
  return options.clearance.value_or(0) > 0 ? kClearSamples : kAllSamples;
}

double least_distance(const JointVec& start, const std::vector<JointVec>& goals) {
  double least = std::numeric_limits<double>::infinity();
  for (const JointVec& goal : goals) least = std::min(least, (goal - start).norm());
  return least;
}

/// Moves ends that stand for regions nearer to the corners beside them, as long as the path becomes
/// shorter by it and its ends keep as much as before.
void pull_ends(const ClearScene& scene, ClearEnds ends, const EndConfigurations& starts, int start,
               const EndConfigurations& goals, const PlanOptions& options, PlanTimes* times,
               PlannedPath& path) {
  PlanOptions quick = options;
  quick.samples = least_samples(options, kFirstRound);
  quick.rounds = 0;
  quick.time_budget = 0;
  quick.enclosure = nullptr;  // there is a path
  const auto least_kept = [](const PlannedPath& of) {
    return of.kept.empty() ? 0 : *std::ranges::min_element(of.kept);
  };
  for (int k = 0; k < kEndPulls && !is_stopped(options.stop); ++k) {
    const JointVec& beside = path.q[path.q.size() - 2];
    const std::vector<JointVec> to{goals.pulled(path.goal, path.q.back(), beside)};
    const JointVec from =
        starts.pulled(start, path.q.front(), path.q.size() > 2 ? path.q[1] : to.front());
    if (to.front() == path.q.back() && from == path.q.front()) return;
    Found other = search_scene(scene, ends, as_span(from), to, quick, times);
    if (!other || other->cost > path.cost * (1 - kPullPaysPath)) return;
    if (least_kept(*other) < least_kept(path)) return;
    other->goal = path.goal;
    path = std::move(*other);
  }
}

/// From each of the starts that are nearest to a goal, which share the samples; the shortest.
Found search_from_each(const ClearScene& scene, ClearEnds ends, const EndConfigurations& starts,
                       const EndConfigurations& goals, const PlanOptions& options,
                       PlanTimes* times) {
  const std::vector<JointVec>& from = starts.q();
  std::vector<std::size_t> order(from.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto far = [&](std::size_t s) { return least_distance(from[s], goals.q()); };
  std::ranges::stable_sort(order, {}, far);
  order.resize(std::min(order.size(), kMaxStarts));
  PlanOptions share = options;
  if (order.size() > 1) {
    share.samples = std::max(all_samples(options) / static_cast<int>(order.size()), 1);
  }
  const TimeLeft left(options);
  std::optional<Found> best;
  for (const std::size_t s : order) {
    const bool found = best && best->has_value();
    if (best && (left.none() || is_stopped(options.stop))) break;
    if (found && far(s) >= (*best)->cost) break;
    if (found) share.samples = std::min(share.samples, kFirstRound);
    Found path = search_scene(scene, ends, as_span(from[s]), goals.q(), left.in(share), times);
    if (path) {
      pull_ends(scene, ends, starts, static_cast<int>(s), goals, left.in(share), times, *path);
      path->start_region = starts.region_of(static_cast<int>(s));
      path->goal_region = goals.region_of(path->goal);
    }
    if (!best || (path && !(found && path->cost >= (*best)->cost))) best = std::move(path);
  }
  return std::move(*best);
}

}  // namespace

Found search_between(const ClearScene& scene, ClearEnds ends, EndConfigurations& starts,
                     EndConfigurations& goals, const PlanOptions& options, PlanTimes* times) {
  // Spheres may be what is in the way; other planners count their samples in other ways.
  const bool once = !scene.checker.solids() || options.planner != Planner::rrt_connect;
  const TimeLeft time(options);
  if (once) return search_from_each(scene, ends, starts, goals, options, times);
  int left = all_samples(options);
  for (int samples = kFirstRound, k = 0;; samples *= 2, ++k) {
    const bool last = samples >= left || (!starts.may_draw() && !goals.may_draw());
    PlanOptions round = time.in(options);
    round.seed += static_cast<std::uint64_t>(k);
    if (!last) round.samples = samples;
    if (last && k > 0) round.samples = left;
    Found found = search_from_each(scene, ends, starts, goals, round, times);
    if (found || found.error().code != WorldErrc::no_path) return found;
    const PlanErrc why = found.error().search.code;
    if (!may_be_others(why) || time.none() || is_stopped(options.stop)) return found;
    if (why == PlanErrc::budget_spent) {
      if (last) return found;
      left -= samples;
    }
    const bool more_starts = starts.draw_more(), more_goals = goals.draw_more();
    if (!more_starts && !more_goals && why != PlanErrc::budget_spent) return found;
  }
}

}  // namespace mjarm::detail
