#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// The outside of a solid as triangles.
struct Surface {
  std::vector<Eigen::Vector3d> vertices = {};      ///< [m]
  std::vector<std::array<int, 3>> triangles = {};  ///< indices in `vertices`
};

/// A box about the origin. @param half  [m] half of its edges, > 0.
[[nodiscard]] Surface box_surface(const Eigen::Vector3d& half);

/// A cylinder about the z axis, in 64 faces around; its volume is that of the round one.
/// @param radius, half_height  [m] > 0
[[nodiscard]] Surface cylinder_surface(double radius, double half_height);

/// Adds a surface that is given in B to one in A.
void append(Surface& surface_A, const Surface& surface_B, const Pose& X_AB);

/// What a camera sees of a body of a model, in the body's frame: all its geoms that are drawn
/// (groups 0 to 2, not transparent), meshes as their files have them.
/// @param body  its name
/// @return bad_input with the nearest name, or where nothing of the body is seen or a geom is a
///         plane or a height field.
[[nodiscard]] Result<Surface> body_surface(const Model& model, std::string_view body);

/// Whether nothing that is drawn tells two bodies of a model apart: geoms of the same shapes, sizes
/// and colours at the same places, in the same order. False where there is no such body.
[[nodiscard]] bool look_alike(const Model& model, std::string_view body, std::string_view other);

}  // namespace mjarm
