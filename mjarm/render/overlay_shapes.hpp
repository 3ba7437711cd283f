#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/render/overlay.hpp"

namespace mjarm::render {

/// A place where two things touch.
struct ContactMark {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
  std::optional<Eigen::Vector3d> force_W = {};    ///< [N] on the robot; none = not known
};

/// How contacts are drawn.
struct ContactLook {
  double radius = 0.008;             ///< [m] of the point, > 0
  double metres_per_newton = 0.002;  ///< length of the arrow, > 0
  double longest = 0.3;              ///< [m] of an arrow, > 0
  Rgba color = {0.95F, 0.55F, 0.10F, 1};
};

/// Appends a point a contact, and an arrow where its force is known and not zero.
void add_contacts(Overlay& overlay, std::span<const ContactMark> contacts,
                  const ContactLook& look = {});

/// Appends the two nearest points of two things [m], a thin line between them and the distance in
/// millimetres; red where they overlap (`distance` < 0) or are nearer than `margin` [m].
void add_closest_pair(Overlay& overlay, const Eigen::Vector3d& p1_W, const Eigen::Vector3d& p2_W,
                      double distance, double margin = 0);

/// How a planned path is drawn: thin, so that it is seen in the trail, which is wide.
struct PathLook {
  double width = 0.002;  ///< [m] > 0
  Rgba color = {0.85F, 0.12F, 0.10F, 1};
  bool dashed = true;  ///< about 60 dashes, of 5 mm at least
};

/// Appends the way of the tool as it is planned, shape (n,).
void add_planned_path(Overlay& overlay, std::span<const Pose> X_WT, const PathLook& look = {});
/// Several of them, which share the dashes of one: a picture can afford so many.
void add_planned_paths(Overlay& overlay, std::span<const std::vector<Pose>> X_WT,
                       const PathLook& look = {});

/// Appends an ellipsoid of velocities [m/s a unit of joint speed] at the tool.
/// @param R_WE       axes as columns.
/// @param semi_axes  [m/s], as `manipulability_ellipsoid` gives them.
/// @param scale      [s] metres drawn a m/s, > 0.
void add_velocity_ellipsoid(Overlay& overlay, const Eigen::Vector3d& p_WT,
                            const Eigen::Matrix3d& R_WE, const Eigen::Vector3d& semi_axes,
                            double scale = 0.2);

/// The arm once more at `q`, shape (dof,) [rad or m].
[[nodiscard]] OverlayGhost ghost_of(const Arm& arm, std::span<const double> q);

}  // namespace mjarm::render
