#pragma once

#include "mjarm/collision/fast_robot_internal.hpp"
#include "mjarm/collision/obstacles.hpp"

namespace mjarm::detail {

/// Obstacles (which were checked) sorted by orientation and, for each link, without those that it
/// never reaches: the arrays behind a FastWorldTables.
struct FastWorld {
  FastWorld(const FastRobotData& robot, const Obstacles& obstacles);
  FastWorld(const FastWorld&) = delete;  // the tables point into it
  FastWorld& operator=(const FastWorld&) = delete;

  std::vector<float> frames;
  std::vector<FastList> lists;
  std::vector<FastRun> lists_of_group;
  std::vector<FastBox> boxes;
  std::vector<FastCylinder> cylinders;
  std::vector<int> box_ids, cylinder_ids;
  FastWorldTables tables;
};

}  // namespace mjarm::detail
