#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/planning/path_keeper_internal.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::detail {

/// One robot among its obstacles.
struct ClearScene {
  const FastChecker& checker;  ///< of the robot without margins
  const Obstacles& obstacles;  ///< that it was made of
  /// Those that keep a clearance, by that; null: they are made each time.
  std::map<double, FastChecker>* made = nullptr;
};

/// What may be nearer than a clearance.
enum class ClearEnds {
  also,  ///< nothing: start and goal keep it as well
  own,   ///< start and goal, and the short edges that lead away from them
};

/// plan_path() for a path that keeps PlanOptions::clearance, which is above 0.
/// @return also PlanErrc::too_near, without what is possible, where start or goals cannot get away
/// from what they are near to.
[[nodiscard]] Result<PlannedPath, PlanFailure> plan_clear(
    const ClearScene& scene, std::span<const double> start, std::span<const JointVec> goals,
    const PlanOptions& options, ClearEnds ends, PlanTimes* times = nullptr);

/// plan_path() without what is nearest to each edge.
[[nodiscard]] Result<PlannedPath, PlanFailure> plan_unmeasured(const FastChecker& checker,
                                                               std::span<const double> start,
                                                               std::span<const JointVec> goals,
                                                               const PlanOptions& options,
                                                               PlanTimes* times);

/// Fills in the least clearance of every edge, as a checker without clearance tells it.
void measure_edges(const FastChecker& checker, PlannedPath& path);

/// Whether a clearance is in its range, where one is given.
[[nodiscard]] inline bool is_sound_clearance(const std::optional<double>& clearance) {
  return !clearance || (*clearance >= 0 && *clearance <= kMaxClearanceAsked);
}

/// Whether less clearance may do where `why` is why a path with some was not found.
[[nodiscard]] bool is_for_clearance(const PlanFailure& why);

/// The largest clearance below PlanOptions::clearance, to a part in 32, for which `plan` finds a
/// path; 0 where only none does.
/// @param plan  plan(options): a result that says whether there is one.
template <class Plan>
[[nodiscard]] double largest_clearance(PlanOptions options, const Plan& plan) {
  constexpr int kTurns = 5, kSamples = 5000;
  options.samples = options.samples > 0 ? std::min(options.samples, kSamples) : kSamples;
  options.rounds = 0;
  options.time_budget = 0;
  double possible = 0, impossible = *options.clearance;
  for (int k = 0; k < kTurns && !is_stopped(options.stop); ++k) {
    options.clearance = 0.5 * (possible + impossible);
    (plan(options) ? possible : impossible) = *options.clearance;
  }
  return possible;
}

/// That, as a failure.
[[nodiscard]] inline PlanFailure too_near(double asked, double possible) {
  return {.code = PlanErrc::too_near, .limit = asked, .possible = possible};
}

/// A configuration that is nearer to something than a clearance, and the place that an edge leads
/// to which keeps it.
struct Exit {
  JointVec q;
  double kept = 0;                    ///< [m] all along the edge
  std::optional<FastChecker> narrow;  ///< that knows what is kept; none: `q` is where it begins
};

/// Finds ways out of where a clearance is not kept.
class ExitSearch {
 public:
  /// @param wide  of the scene, with the clearance as its margins.
  /// @param keeper  may be null.
  ExitSearch(const ClearScene& scene, const FastChecker& wide, const PathKeeper* keeper,
             const PlanOptions& options)
      : scene_(scene), wide_(wide), keeper_(keeper), options_(options) {}

  /// The nearest place that is found.
  /// @param q  free.
  [[nodiscard]] std::optional<Exit> leave(const JointVec& q) const;

  /// Moves an exit onto the way to `next`, where that is a straight way out as well.
  void straighten(const JointVec& q, const JointVec& next, Exit& exit) const;

 private:
  [[nodiscard]] bool is_way_out(const JointVec& from, const JointVec& to,
                                const FastChecker& narrow) const;
  [[nodiscard]] JointVec uphill(const JointVec& q) const;
  [[nodiscard]] std::optional<JointVec> climb(const JointVec& q, const FastChecker& narrow) const;
  [[nodiscard]] std::optional<JointVec> draw(const JointVec& q, double farthest,
                                             const FastChecker& narrow) const;

  const ClearScene& scene_;
  const FastChecker& wide_;
  const PathKeeper* keeper_;
  const PlanOptions& options_;
};

/// The checker of the scene that calls free only what keeps `clearance`.
[[nodiscard]] FastChecker checker_with(const ClearScene& scene, double clearance);
/// The same for less than what `wide` keeps, a checker of the scene: for one that looks closer, it
/// is made at once.
[[nodiscard]] FastChecker checker_within(const ClearScene& scene, const FastChecker& wide,
                                         double clearance);

}  // namespace mjarm::detail
