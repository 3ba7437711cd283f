#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// One geom of a body, as it collides, in the frame G of its own.
struct ShapePart {
  enum class Kind { box, cylinder, capsule, ball, ellipsoid, hull };

  Kind kind = Kind::box;
  Pose X_BG;  ///< in the frame of the body
  /// [m] box and ellipsoid: half extents; ball: the radius; cylinder and capsule: radius and half
  /// length along z; hull: half extents of a box round it.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> vertices = {};  ///< [m] hull: its corners, in G
  std::vector<std::array<int, 3>> faces =
      {};  ///< hull: triangles, seen from outside they turn left
};

/// How heavy a body is, with all that hangs on it.
struct ObjectMass {
  Eigen::Vector3d center_B = Eigen::Vector3d::Zero();  ///< [m] of mass
  double mass = 0;                                     ///< [kg]
};

/// What a body that can be carried consists of, with all that hangs on it.
struct ObjectShape : ObjectMass {
  std::vector<ShapePart> parts;  ///< those that collide
};

/// The mass of the body with that number; joints below it stand at their initial values.
[[nodiscard]] ObjectMass object_mass(const Model& model, int body);

/// The shape of the body with that number; joints below it stand at their initial values. Planes,
/// height fields and flexes are left out.
[[nodiscard]] ObjectShape object_shape(const Model& model, int body);

}  // namespace mjarm
