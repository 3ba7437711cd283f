#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mjarm/core/stopwatch.hpp"
#include "mjarm/planning/path_keeper_internal.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::detail {

/// Says when a search has to end; asks the user each time, and the clock if there is an end at all.
class Deadline {
 public:
  Deadline() = default;
  /// @param us  [us] from now; 0: none.
  explicit Deadline(StopCheck stop, double us = 0) : stop_(std::move(stop)), left_us_(us) {}
  bool passed() const { return (left_us_ > 0 && watch_.us() > left_us_) || is_stopped(stop_); }

 private:
  StopCheck stop_;
  Stopwatch watch_;
  double left_us_ = 0;  // 0: never
};

/// What is left of PlanOptions::time_limit to work that consists of several searches.
class TimeLeft {
 public:
  explicit TimeLeft(const PlanOptions& options) : limit_(options.time_limit) {}
  bool none() const { return limit_ > 0 && left() <= 0; }
  /// `options` with what is left.
  PlanOptions in(PlanOptions options) const {
    if (limit_ > 0) options.time_limit = std::max(left(), 1e-6);
    return options;
  }
  /// Time that does not count.
  void add(double us) { limit_ += limit_ > 0 ? 1e-6 * us : 0; }

 private:
  double left() const { return limit_ - 1e-6 * watch_.us(); }
  Stopwatch watch_;
  double limit_;  // [s]; 0: none
};

/// What PlanOptions::samples of 0 stands for: without and with a clearance.
inline constexpr int kAllSamples = 100'000, kClearSamples = 30'000;
/// PlanOptions::samples, but no more than `max`.
[[nodiscard]] inline int least_samples(const PlanOptions& options, int max) {
  return options.samples > 0 ? std::min(options.samples, max) : max;
}

/// A problem whose start and goals were checked. Its spans are those of the user.
struct SearchProblem {
  const FastChecker& checker;
  std::span<const double> start;
  std::vector<std::span<const double>> goals;  ///< free ones, nearest first
  std::vector<int> goal_index;                 ///< of each in what the user gave
  std::optional<PathKeeper> keeper = {};       ///< of PlanOptions::tilt and within
  /// [rad or m] only shorter paths count.
  double max_cost = std::numeric_limits<double>::infinity();
  Deadline deadline{};
};

/// The first joint outside of its limits; -1 where there is none.
[[nodiscard]] int outside_joint(const Arm& arm, std::span<const double> q);

/// Proves edges and counts them. The checker lets pass what is outside of the limits by less than
/// its rounding; here the limits count as they do for start and goals.
class EdgeProver {
 public:
  /// @param keeper  may be null.
  EdgeProver(const FastChecker& checker, const PathKeeper* keeper, const PlanOptions& options,
             PlanCounts& counts)
      : checker_(checker), keeper_(keeper), edge_{options.resolution}, counts_(counts) {}

  EdgeResult look(std::span<const double> a, std::span<const double> b) {
    ++counts_.edges;
    const Arm& arm = checker_.robot().arm();
    if (outside_joint(arm, a) >= 0) return {EdgeVerdict::outside, 0};
    if (outside_joint(arm, b) >= 0) return {EdgeVerdict::outside, 1};
    if (keeper_ != nullptr) {
      const PathKeeper::Edge found = keeper_->look(a, b);
      if (!found.kept) return {EdgeVerdict::undecided, found.t};
    }
    return check_edge(checker_, a, b, edge_);
  }
  bool is_free(std::span<const double> a, std::span<const double> b) {
    return look(a, b).verdict == EdgeVerdict::free;
  }

 private:
  const FastChecker& checker_;
  const PathKeeper* keeper_;
  EdgeOptions edge_;
  PlanCounts& counts_;
};

/// [rad or m] no path through `q` is shorter.
[[nodiscard]] double least_cost_through(const SearchProblem& problem, std::span<const double> q);

inline double distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

/// a + share * (b - a).
inline void between(std::span<const double> a, std::span<const double> b, double share,
                    std::span<double> out) {
  for (std::size_t k = 0; k < a.size(); ++k) out[k] = a[k] + share * (b[k] - a[k]);
}

/// The planners. A path from start to a goal, or how near it came.
[[nodiscard]] Result<RawPath, PlanFailure> rrt_connect(const SearchProblem& problem,
                                                       const PlanOptions& options);
[[nodiscard]] Result<RawPath, PlanFailure> rrt_star(const SearchProblem& problem,
                                                    const PlanOptions& options);
[[nodiscard]] Result<RawPath, PlanFailure> ompl_search(const SearchProblem& problem,
                                                       const PlanOptions& options);

/// Shortens `path` in place by so many attempts to cut corners; its edges stay proved.
/// @param keeper  may be null.
void shorten(const FastChecker& checker, const PathKeeper* keeper, const PlanOptions& options,
             int attempts, RawPath& path);

/// Shortens `path` in place by so many attempts to move one of its corners a little.
/// @param keeper  may be null.
void slide_corners(const FastChecker& checker, const PathKeeper* keeper, const PlanOptions& options,
                   int attempts, RawPath& path);

/// Checks the options, the start and every goal.
[[nodiscard]] Result<SearchProblem, PlanFailure> validate_problem(const FastChecker& checker,
                                                                  std::span<const double> start,
                                                                  std::span<const JointVec> goals,
                                                                  const PlanOptions& options);

}  // namespace mjarm::detail
