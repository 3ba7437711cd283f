#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "mjarm/planning/task_region.hpp"

namespace mjarm::testing {

/// A region as its mechanism has it, without the code under test.
inline TaskRegion moved_region(const TaskRegion& region, double value) {
  const Mechanism& by = *region.mechanism;
  Eigen::Isometry3d move = Eigen::Isometry3d::Identity();
  if (by.type == JointType::hinge) {
    move = Eigen::Translation3d(by.p_W) * Eigen::AngleAxisd(value, by.axis_W) *
           Eigen::Translation3d(-by.p_W);
  } else {
    move.translation() = value * by.axis_W;
  }
  TaskRegion out = region;
  out.mechanism.reset();
  out.X_WR = {move * region.X_WR.p, move.linear() * region.X_WR.R};
  return out;
}

/// [m and rad] the most of the smaller of both rooms for any value of the mechanism: of many, those
/// about which it is largest searched closer.
inline double most_room(const TaskRegion& region, const Pose& X_WT, int values = 500) {
  const Mechanism& by = *region.mechanism;
  const auto room = [&](double value) {
    const RegionRoom there = room_in(moved_region(region, value), X_WT);
    return std::min(there.place, there.turn);
  };
  const auto value_of = [&](int k) {
    return by.min + (by.max - by.min) * std::clamp(k, 0, values) / values;
  };
  std::vector<double> rooms;
  for (int k = 0; k <= values; ++k) rooms.push_back(room(value_of(k)));
  const auto at = [&](int k) { return rooms[static_cast<std::size_t>(std::clamp(k, 0, values))]; };
  double best = *std::ranges::max_element(rooms);
  for (int k = 0; k <= values; ++k) {
    if (at(k) < at(k - 1) || at(k) < at(k + 1)) continue;
    double least = value_of(k - 1), most = value_of(k + 1);
    for (int i = 0; i < 35; ++i) {
      const double a = least + (most - least) / 3, b = most - (most - least) / 3;
      if (room(a) < room(b)) {
        least = a;
      } else {
        most = b;
      }
    }
    best = std::max(best, room(0.5 * (least + most)));
  }
  return best;
}

}  // namespace mjarm::testing
