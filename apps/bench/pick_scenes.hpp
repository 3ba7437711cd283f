#pragma once

#include <string>
#include <vector>

#include "apps/bench/pick.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::app {

/// How an object may rest: what is up then, and the height of its frame above what it lies on.
struct Rest {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  double height = 0;  ///< [m]
};

/// The ways in which an object of the shipped tables rests; the first is how it stands.
[[nodiscard]] std::vector<Rest> rests_of(const std::string& object);
/// Mostly how it stands.
[[nodiscard]] Rest random_rest(Rng& rng, const std::string& object);

/// The part of the table on which objects are put.
[[nodiscard]] bool is_on_table(double x, double y);
/// So resting at (x, y) [m] on the table, turned by `yaw` [rad].
[[nodiscard]] Pose on_table(const Rest& rest, double x, double y, double yaw);
/// Anywhere there, turned at will.
[[nodiscard]] Pose somewhere_on_table(Rng& rng, const Rest& rest);
/// Anywhere in the tray, turned at will.
[[nodiscard]] program::PlaceGoal somewhere_in_tray(Rng& rng, const Rest& rest);

}  // namespace mjarm::app
