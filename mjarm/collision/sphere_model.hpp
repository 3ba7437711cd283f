#pragma once

#include <map>
#include <string>
#include <vector>

#include "mjarm/collision/obstacles.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A robot of spheres and its obstacles as a MuJoCo model, for ExactChecker.
struct SphereModel {
  Model model;
  Arm arm;  ///< as given, its joints found in `model`
  /// The link or obstacle that each geom stands for, by the geom's name; a number for an
  /// obstacle without a name.
  std::map<std::string, std::string> parts;
};

/// A sphere model to be looked at: with light and colours, and nothing in it collides. The arm is a
/// thin chain from joint to joint and on to the tool; its spheres are in group 3.
struct SphereModelLook {
  std::vector<int> see_through = {};  ///< solids (by index) that hide something
};

/// Builds the model: a body a joint, a geom a sphere and an obstacle. What collides are the spheres
/// with the obstacles, and the spheres of paired links with each other; nothing else. ExactChecker
/// leaves out pieces at rest against obstacles, which no joint can change.
/// A cloud is a geom a point.
/// @param look  where given, it is for pictures and not for ExactChecker.
/// @return not_available for polytopes, meshes and height fields; check_sphere_set()'s or
/// check_obstacles()'s error, or what MuJoCo has against the model.
[[nodiscard]] Result<SphereModel> sphere_model(const Arm& arm, const SphereSet& set,
                                               const Obstacles& obstacles,
                                               const SphereModelLook* look = nullptr);

}  // namespace mjarm
