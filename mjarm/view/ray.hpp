#pragma once

#include <Eigen/Core>
#include <optional>

#include "mjarm/render/camera.hpp"
#include "mjarm/render/scene.hpp"

namespace mjarm::view {

/// A half line in the world frame W.
struct Ray {
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitX();  ///< unit

  /// The point `way` [m] from the origin.
  [[nodiscard]] Eigen::Vector3d at(double way) const { return origin_W + way * direction_W; }
};

/// How a picture sees the world: where its camera is, and what it takes in. `lower`, `upper` and
/// `middle` are metres at a distance of one metre (tangents), or, with an orthographic camera,
/// metres at any distance.
struct Eye {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();         ///< [m]
  Eigen::Vector3d forward_W = Eigen::Vector3d::UnitX();  ///< unit
  Eigen::Vector3d up_W = Eigen::Vector3d::UnitZ();       ///< unit, at right angles to forward
  double lower = -0.4;                                   ///< lower edge
  double upper = 0.4;                                    ///< upper edge, > lower
  double middle = 0;                                     ///< middle of the picture to the right
  double near = 0.01;                                    ///< [m] what is nearer is cut off, > 0
  bool orthographic = false;

  [[nodiscard]] Eigen::Vector3d right_W() const { return forward_W.cross(up_W); }
  /// [m] height of the picture at the depth of a point, measured along `forward_W`; not above 0 for
  /// points behind.
  [[nodiscard]] double height_at(const Eigen::Vector3d& p_W) const;
};

/// The eye of a free camera as MuJoCo places it.
/// @param fovy  [rad] vertical field of view, in (0, pi).
[[nodiscard]] Eye eye_of(const render::CameraView& view, double fovy);
/// The eye with which `scene` was last updated, whatever its camera.
[[nodiscard]] Eye eye_of(render::Scene& scene);

/// The ray into the world through a place of a picture.
/// @param width, height  [px] of the picture, > 0.
/// @param x, y  [px] from the left upper corner; the middle of the first pixel is (0.5, 0.5).
[[nodiscard]] Ray ray_of_pixel(const Eye& eye, int width, int height, double x, double y);

/// The same through shares of the picture's width and height, from its lower left corner.
/// @param aspect  width over height.
[[nodiscard]] Ray ray_of_share(const Eye& eye, double aspect, double x, double y);

/// The place of a point of the world in a picture, as above; none behind the eye.
[[nodiscard]] std::optional<Eigen::Vector2d> pixel_of_point(const Eye& eye, int width, int height,
                                                            const Eigen::Vector3d& p_W);

}  // namespace mjarm::view
