#pragma once

#include <span>
#include <vector>

#include "mjarm/collision/fast_grid_internal.hpp"
#include "mjarm/collision/fast_robot_internal.hpp"
#include "mjarm/collision/fast_tree_internal.hpp"
#include "mjarm/collision/obstacles.hpp"

namespace mjarm::detail {

/// Obstacles (which were checked) sorted by orientation and, for each link, without those that it
/// never reaches, many solids and the points of clouds in trees: the arrays behind a
/// FastWorldTables.
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
  std::vector<std::uint64_t> ignored;
  FastTreeNodes crowd, clouds;
  std::vector<FastItem> items;
  std::vector<FastTriangle> triangles;
  std::vector<FastPlane> planes;
  std::vector<FastPolytope> polytopes;
  std::vector<FastPoints> points;
  std::vector<int> point_ids;
  FastGridCells grid;
  FastWorldTables tables;
};

/// Puts the points of all clouds within `reach` of `middle_F` into the tree of `out`.
/// @param R_WF      of frame 0.
/// @param first_id  of the first cloud.
void add_clouds(std::span<const PointCloud> clouds, const Eigen::Matrix3d& R_WF,
                const Eigen::Vector3d& middle_F, double reach, int first_id, FastWorld& out);

/// Marks these points in the grid of `out`.
/// @return [m] by how much some are larger than their marks.
double mark_clouds(FastWorld& out);

}  // namespace mjarm::detail
