#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/surface.hpp"
#include "mjarm/perception/raster_internal.hpp"

namespace mjarm::perception {

/// A surface, and which of its triangles have to be drawn.
struct DrawnSurface {
  explicit DrawnSurface(Surface of);
  Surface surface;
  Raster::Sides sides;  ///< those in front where the surface is closed and goes round one way
};

/// A surface with what the search for it asks again and again.
struct ShapeModel {
  explicit ShapeModel(Surface of);
  DrawnSurface fine;
  DrawnSurface coarse;  ///< with details below 0.15 of its radius left out
  Eigen::Vector3d centre =
      Eigen::Vector3d::Zero();  ///< [m] mean of the surface, in the object's frame O
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< of its inertia, in O
  double radius = 0;                                   ///< [m] about the centre
  double inner = 0;                      ///< [m] of a ball about it that is all solid; 0: unknown
  std::vector<Eigen::Vector3d> points;   ///< [m] evenly spread over the surface, in O
  std::vector<Eigen::Vector3d> normals;  ///< unit length, of either side
};

/// [m] How far the surface in pose `A` is from that in pose `B`: root of the mean squared distance
/// of points to the nearest point's tangent plane. About 0 for poses that the object's symmetry
/// makes the same, whatever that symmetry is.
[[nodiscard]] double surface_distance(const ShapeModel& shape, const Pose& A, const Pose& B);

/// [m^2] (6, 6) M: a twist t = (v, w) about the centre, in the frame of `X`, moves the surface
/// along its normals by sqrt(t^T M t), root mean square. Zero for motions along its symmetry.
[[nodiscard]] Eigen::Matrix<double, 6, 6> normal_motion(const ShapeModel& shape, const Pose& X);

}  // namespace mjarm::perception
