#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/render/image.hpp"

namespace mjarm::render {

/// How a camera without distortion maps points to pixels. The camera's frame C has x to the right,
/// y down and z along the line of sight; pixel (0, 0) is the upper left one, and whole numbers are
/// the middles of pixels.
struct CameraIntrinsics {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fx = 0;   ///< [px] focal length across
  double fy = 0;   ///< [px] focal length down
  double cx = 0;   ///< [px] column of the line of sight
  double cy = 0;   ///< [px] row of it

  /// Pixel [px] of a point [m] in front of the camera.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_C) const {
    return {fx * p_C.x() / p_C.z() + cx, fy * p_C.y() / p_C.z() + cy};
  }
  /// Where the ray through a pixel [px] is at depth 1: (x, y, 1). Times a depth it is the point.
  [[nodiscard]] Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1};
  }
};

/// What an RGB-D camera sees at one moment.
struct RgbdFrame {
  Image color = {};
  /// [m] (height * width,) row by row from the top: along the line of sight, in the middle of each
  /// pixel, of the same pixels as `color`; 0 or no number where nothing was measured.
  std::vector<float> depth = {};
  CameraIntrinsics intrinsics = {};
  Pose X_WC = {};  ///< the camera in the world
};

}  // namespace mjarm::render
