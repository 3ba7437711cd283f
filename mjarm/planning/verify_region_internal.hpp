#pragma once

#include <functional>
#include <optional>

#include "mjarm/core/pose.hpp"
#include "mjarm/planning/plan_file.hpp"

namespace mjarm::detail {

/// [m or rad] of room that may be lacking.
inline constexpr double kRoomSlack = 1e-6;

/// Looks at the tool along a path, whether it has the room in a region that is stated. Where the
/// mechanism of one may stand is searched, with nothing of value_for(), and followed.
class RegionWatch {
 public:
  struct Found {
    bool kept = false;    ///< what is stated
    bool jumped = false;  ///< but the mechanism would have to jump
    RegionRoom room = {};
  };

  /// @param given  is_sound(); must outlive this.
  explicit RegionWatch(const GivenRegion& given) : given_(given) {}

  /// The next place of an edge.
  /// @param X_WT  the tool on the edge.
  /// @param from  where it was looked at before.
  [[nodiscard]] Found look(const std::function<Pose(double)>& X_WT, double from, double to);

 private:
  [[nodiscard]] double spare(const RegionRoom& room) const;
  [[nodiscard]] double spare(double value, const Pose& X_WT) const;
  [[nodiscard]] double best_between(double least, double most, const Pose& X_WT) const;
  [[nodiscard]] double best_of_all(const Pose& X_WT) const;
  [[nodiscard]] bool follow(const Pose& X_WT);

  const GivenRegion& given_;
  std::optional<double> value_;  // of the mechanism
};

}  // namespace mjarm::detail
