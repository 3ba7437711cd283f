#pragma once

#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/surface.hpp"
#include "mjarm/render/rgbd_frame.hpp"

namespace mjarm::perception {

/// Draws surfaces as inverse depth, in memory: what a depth camera would see of them. Keeps its
/// memory from picture to picture.
class Raster {
 public:
  /// An empty picture of this size; lens.width times lens.height pixels.
  void clear(const render::CameraIntrinsics& lens);
  /// Which triangles are drawn: all, or those alone that go round counterclockwise as they are
  /// seen.
  enum class Sides { both, front };
  /// Adds a surface; triangles that reach behind the camera are left out.
  void draw(const Surface& surface, const Pose& X_CO, Sides sides = Sides::both);
  /// [1/m] (height * width,) row by row; 0 where nothing is.
  [[nodiscard]] const std::vector<float>& inverse() const noexcept { return inverse_; }

 private:
  using Corner = Eigen::Vector3f;  ///< column, row, 1/z
  void draw_triangle(const Corner& p, const Corner& q, const Corner& r, Sides sides);
  render::CameraIntrinsics lens_;
  std::vector<float> inverse_;
  std::vector<Corner> corners_;  ///< of each vertex
};

}  // namespace mjarm::perception
