#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::detail {

/// A geom as SceneWatch places it; a finger has several, all along its way.
struct WatchShape {
  int geom = -1;
  int joint = -1;       ///< of the arm, that moves it; -1: none does
  int object = -1;      ///< number of the body with a free joint that it is of; -1: of none
  bool finger = false;  ///< moved by the gripper
  bool still = false;   ///< it never moves
  Pose X_LG;            ///< joint >= 0: in the frame of that joint
  double radius = 0;    ///< [m] of the ball round its centre; 0: unbounded (a plane)
  double reach = 0;     ///< [m] joint >= 0: no point is farther than this from any joint's origin
};

/// Two shapes that are to be kept apart, by index.
struct WatchPair {
  int a = -1, b = -1;
};

/// All that SceneWatch looks at.
struct WatchPairs {
  std::vector<WatchShape> shapes;
  std::vector<WatchPair> pairs;
};

/// @return SceneWatch::create()'s not_available.
[[nodiscard]] Result<WatchPairs> watch_pairs(const Model& model, const Arm& arm);

}  // namespace mjarm::detail
