#include <utility>

#include "mjarm/planning/search_internal.hpp"

namespace mjarm {
namespace {

constexpr int kSamplesOfRound = 1000;  // a round that finds nothing by then ends
constexpr double kShare = 3;  // of the best cost: a raw path must be below, as cuts shorten it
constexpr int kCuts = 40;     // attempts at once to cut corners,
constexpr int kCutTurns = 8;  // so many times at most,
constexpr double kCutPays = 0.005;  // as long as each saves this share;
constexpr int kSlides = 100;        // then attempts to move them
constexpr int kSlideTurns = 6;
constexpr double kSlidePays = 0.001;
constexpr double kPromise = 1.15;  // a path that is longer than the best one by this factor is left
constexpr double kProofShare = 0.93;  // of the time; the rest is for the last cuts and the proof

/// Shortens paths as long as that pays and they may become shorter than the best one.
class Settler {
 public:
  Settler(const detail::SearchProblem& problem, const PlanOptions& options)
      : problem_(problem), options_(options) {}

  /// @param cost  of the best path.
  void settle(std::uint64_t seed, double cost, RawPath& path) {
    options_.seed = seed;
    repeat(kCutTurns, kCutPays, cost, path,
           [&] { detail::shorten(problem_.checker, keeper(), options_, kCuts, path); });
    repeat(kSlideTurns, kSlidePays, cost, path,
           [&] { detail::slide_corners(problem_.checker, keeper(), options_, kSlides, path); });
  }

 private:
  template <class Turn>
  void repeat(int turns, double pays, double cost, RawPath& path, const Turn& turn) {
    double length = path_length(path.q);
    for (int k = 0; k < turns && !problem_.deadline.passed(); ++k) {
      const double before = length;
      options_.seed += 1000003;
      turn();
      length = path_length(path.q);
      if (length > kPromise * cost || length > (1 - pays) * before) return;
    }
  }

  const detail::PathKeeper* keeper() const { return problem_.keeper ? &*problem_.keeper : nullptr; }

  const detail::SearchProblem& problem_;
  PlanOptions options_;
};

/// Leaves out goals that no path shorter than `cost` reaches; the nearest one stays.
void leave_out_far(detail::SearchProblem& problem, double cost) {
  while (problem.goals.size() > 1 &&
         detail::distance(problem.start, problem.goals.back()) >= cost) {
    problem.goals.pop_back();
    problem.goal_index.pop_back();
  }
}

}  // namespace

RawPath improve_path(const FastChecker& checker, std::span<const double> start,
                     std::span<const JointVec> goals, RawPath best, const PlanOptions& options,
                     double left_us) {
  auto problem = detail::validate_problem(checker, start, goals, options);
  if (!problem) return best;
  const bool timed = options.time_budget > 0;
  if (timed && left_us <= 0) return best;
  if (timed) problem->deadline = detail::Deadline(options.stop, kProofShare * left_us);
  PlanOptions round = options;
  round.samples = kSamplesOfRound;
  round.enclosure = nullptr;  // there is a path
  round.progress = {};
  Settler settler(*problem, round);
  settler.settle(round.seed, path_length(best.q), best);
  double cost = path_length(best.q);
  const double least = detail::distance(start, problem->goals.front()) * (1 + 1e-12);
  const auto goes_on = [&](int k) {
    return cost > least && (timed || k < options.rounds) && !problem->deadline.passed();
  };
  for (int k = 0; goes_on(k); ++k) {
    ++round.seed;
    problem->max_cost = kShare * cost;
    leave_out_far(*problem, cost);
    Result<RawPath, PlanFailure> found = detail::rrt_connect(*problem, round);
    if (!found) continue;
    settler.settle(round.seed, cost, *found);
    const double length = path_length(found->q);
    if (!(length < cost)) continue;
    best = std::move(*found);
    cost = length;
  }
  return best;
}

}  // namespace mjarm
