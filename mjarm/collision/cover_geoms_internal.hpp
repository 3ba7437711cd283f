#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <string>
#include <vector>

#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/cover_solid_internal.hpp"
#include "mjarm/collision/exact_arm_bodies_internal.hpp"

namespace mjarm::detail {

/// A geom in the frame L of the link it is on (of an obstacle: in the world).
struct PlacedGeom {
  int geom = -1;
  Pose X_LG;
};

/// Geoms of one link that collide with the same things.
struct GeomGroup {
  std::string name;
  int joint = -1;  ///< that moves them; -1: at rest, an obstacle of one geom
  std::vector<PlacedGeom> geoms;
};

/// The geoms of a model that can meet because of the arm.
struct GeomGroups {
  std::vector<GeomGroup> links, obstacles;
  int root = 0;  ///< body under the world that the arm hangs on
};

/// Sorts the geoms of a model. @return what cover_model() says about arm and options.
[[nodiscard]] Result<GeomGroups> group_geoms(const Model& model, const Arm& arm,
                                             const CoverOptions& options);

/// A solid that contains the geom: exact, but for a mesh, where it is what MuJoCo collides, the
/// convex hull, and for a plane or height field, which an arm does not carry: its box.
[[nodiscard]] CoverSolid solid_of_geom(const mjModel& m, const PlacedGeom& placed);

/// The geom as an obstacle: exact, but for a mesh, a height field and an ellipsoid, where it is a
/// simpler solid round it.
[[nodiscard]] Obstacle obstacle_of_geom(const mjModel& m, const PlacedGeom& placed);

}  // namespace mjarm::detail
