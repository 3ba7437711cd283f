#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/planning/region_proof_internal.hpp"

namespace mjarm::detail {

/// Keeps the tool within regions all along a path: proves edges, and puts configurations back.
class PathKeeper {
 public:
  /// That of PlanOptions::tilt and PlanOptions::within; none where there is neither.
  [[nodiscard]] static std::optional<PathKeeper> create(const PlanOptions& options, const Arm& arm);

  [[nodiscard]] bool keeps(std::span<const double> q) const;
  /// [rad or m, L2] steps of searches.
  [[nodiscard]] double range() const noexcept { return range_; }

  /// Moves `q` the shortest way (Newton's method on the pseudo-inverse of those bounds that are
  /// broken, as the projection of D. Berenson et al., CBiRRT, ICRA 2009) to some way inside of the
  /// bounds; one that is there already stays.
  /// @return false where that fails within the joint limits.
  [[nodiscard]] bool project(std::span<double> q) const;

  /// Writes to `out` the place a step of `range` from `from` towards `to`, put back.
  /// @param range  [rad or m, L2] > 0, less than what is between both.
  /// @return [rad or m, L2] length of the step, up to twice `range`; none where it leads nowhere.
  [[nodiscard]] std::optional<double> step(std::span<const double> from, std::span<const double> to,
                                           double range, std::span<double> out) const;

  /// What is known of the straight edge between two configurations.
  struct Edge {
    bool kept = false;  ///< proved
    double t = 0;       ///< where it is not kept, or not proved, 0 to 1
    /// What is left all along the edge, where it is kept: [rad] of PlanOptions::tilt,
    double tilt_room = std::numeric_limits<double>::infinity();
    RegionRoom room = {};  ///< of PlanOptions::within
  };
  /// Parts of the edge are looked at that are as wide as can be proved.
  [[nodiscard]] Edge look(std::span<const double> q0, std::span<const double> q1) const;

 private:
  explicit PathKeeper(const Arm& arm) : chain_(Chain(arm)), limits_(arm.limits) {}

  LinkChain chain_;
  JointLimits limits_;
  std::optional<RegionProof> tilt_, within_;
  double range_ = kKeptRange;
};

/// Writes to a path by how much its tool leans and the room that it has.
/// @param keeper  of `options`; null: there is nothing to keep.
/// @return false where an edge is not proved.
[[nodiscard]] bool prove_kept(const PathKeeper* keeper, const PlanOptions& options,
                              PlannedPath& path);

/// [rad or m, L2] longest edges of a search.
[[nodiscard]] inline double range_of(const PathKeeper* keeper, const PlanOptions& options) {
  return keeper != nullptr ? std::min(options.range, keeper->range()) : options.range;
}

}  // namespace mjarm::detail
