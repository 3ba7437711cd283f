#pragma once

#include <string>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// What a body is to an arm.
enum class BodyRole {
  scene,   ///< it stands, or moves by joints that are not the arm's
  link,    ///< a link of the arm
  hand,    ///< beyond the arm's last joint: flange, hand, fingers
  object,  ///< it can be carried away
};

/// A body with a free joint that does not carry the arm, with all that hangs on it.
struct SceneObject {
  std::string name;  ///< of the body; `#7`, its number, where it has none
  int body = -1;     ///< its number in the model
  int qpos = -1;     ///< the first of the seven rows of its free joint
};

/// The bodies of a model by what they are to an arm; all vectors are per body.
struct SceneBodies {
  std::vector<std::string> name;  ///< `#7`, its number, where it has none
  std::vector<BodyRole> role;
  std::vector<int> object_of;  ///< index in `objects`, -1 for what is no object
  /// Number of the arm's joints that move it: two bodies of the arm with the same number never move
  /// against each other by the arm (two fingers; two parts of another arm on the same torso).
  std::vector<int> moved_by;
  std::vector<SceneObject> objects;
};
[[nodiscard]] SceneBodies scene_bodies(const Model& model, const Arm& arm);

}  // namespace mjarm
