#pragma once

#include <Eigen/Core>
#include <span>

#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::render {

/// A ball that has to be in a picture, in the world frame W; a point where its radius is 0.
struct FramedBall {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0;                              ///< [m] >= 0
};

/// From where a picture is taken, but for the distance. The angles are those of CameraView.
struct LineOfSight {
  double azimuth = 0;        ///< [rad]
  double elevation = 0;      ///< [rad] -pi/2 to pi/2
  double aspect = 16.0 / 9;  ///< width of the picture by its height, > 0
};

/// The free camera that looks along `sight` and is as near as it can be with all of `balls` in the
/// picture, and a narrow margin round them. `lookat_W` is as deep in the picture as they are on
/// average.
/// @param model  says how wide the free camera sees.
/// @return default_view() in that direction where there is no ball, or one is not finite.
[[nodiscard]] CameraView framing_view(const Model& model, std::span<const FramedBall> balls,
                                      const LineOfSight& sight);

/// [m] where the camera itself stands, in the world.
[[nodiscard]] Eigen::Vector3d camera_place(const CameraView& view);

}  // namespace mjarm::render
