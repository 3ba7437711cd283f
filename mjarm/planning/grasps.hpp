#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/jaws.hpp"
#include "mjarm/model/object_shape.hpp"

namespace mjarm {

/// How a body can be held between two fingers.
struct Grasp {
  Pose X_BT;              ///< the tool in the frame of the body, before the fingers close
  double width = 0;       ///< [m] of what comes between the fingers
  double off_center = 0;  ///< [m] from the centre of mass to the line on which the fingers press
};

/// What is asked of grasps. Every default is usable as is.
struct GraspOptions {
  double spare = 0.006;    ///< [m] >= 0 by which the open gripper is wider than what it holds
  double keep_off = 2e-3;  ///< [m] >= 0 of the palm from the body, of the tips from its far side
  double contact = 4e-3;   ///< [m] >= 0 that the fingers reach over the body at least
  /// Directions that are tried: of closing round an axis of symmetry, over half a turn; of approach
  /// round the line of closing, over a whole turn. 4 to 64.
  int turns = 8;
  /// A direction of approach (unit, in the body's frame) that is among those tried round every line
  /// of closing, as near as may be: straight down, for instance. Zero: any.
  Eigen::Vector3d approach_B = Eigen::Vector3d::Zero();
  double slope = 0.2;  ///< [rad] by which two faces may be off parallel, half of it each, > 0
};

/// The grasps of one body.
struct Grasps {
  std::vector<Grasp> all;  ///< the least off the centre of mass first
  double narrowest = 0;    ///< [m] the least width found, whether it fits or not; inf: none found
};

/// Grasps by the geometry of the parts of a body: opposite faces of a box, diameters and ends of a
/// cylinder, and so on; of a hull, points whose outward normals are opposite (antipodal pairs, as
/// Nguyen, "Constructing force-closure grasps", 1988, has them) found by rays through it from the
/// middle of its faces. Each is held from all sides round the line of closing, either way round. Of
/// arm and scene nothing is known here. The same input gives the same grasps.
[[nodiscard]] Grasps find_grasps(const ObjectShape& shape, const Jaws& jaws,
                                 const GraspOptions& options = {});

}  // namespace mjarm
