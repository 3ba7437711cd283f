#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
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

/// A place on a surface, in the surface's frame.
struct SurfacePoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();        ///< [m]
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit normal, away from the solid
};

/// Draws points of a surface: every part of its area is as likely.
class SurfacePoints {
 public:
  explicit SurfacePoints(Surface surface);

  [[nodiscard]] double area() const noexcept {
    return up_to_.empty() ? 0 : up_to_.back();
  }  ///< [m^2]
  /// The point at a share of the area, counted triangle by triangle, anywhere in its triangle.
  /// Shares in equal steps spread points evenly. Needs area() > 0.
  /// @param share  in [0, 1]
  [[nodiscard]] SurfacePoint draw(double share, Rng& rng) const;

 private:
  Surface surface_;
  std::vector<double> up_to_;  ///< [m^2] of the triangles up to each one
};

/// Adds a surface that is given in B to one in A.
void append(Surface& surface_A, const Surface& surface_B, const Pose& X_AB);

/// What a camera sees of a body of a model, in the body's frame: all its geoms that are drawn
/// (groups 0 to 2, not transparent), meshes as their files have them.
/// @param body  its name
/// @return bad_input with the nearest name, or where nothing of the body is seen or a geom is a
///         plane or a height field.
[[nodiscard]] Result<Surface> body_surface(const Model& model, std::string_view body);
/// The same of a body by its number in the model, as it may have no name.
[[nodiscard]] Result<Surface> body_surface(const Model& model, int body);

/// Whether nothing that is drawn tells two bodies of a model apart: geoms of the same shapes, sizes
/// and colours at the same places, in the same order. False where there is no such body.
[[nodiscard]] bool look_alike(const Model& model, std::string_view body, std::string_view other);

}  // namespace mjarm
