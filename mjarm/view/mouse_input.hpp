#pragma once

#include <Eigen/Core>
#include <functional>

namespace mjarm::view {

/// Something the mouse did over the picture (not over panels), for tools that live in the scene.
struct MouseInput {
  enum class Kind { press, move, release };
  Kind kind = Kind::move;
  int button = 0;  ///< 0 = left, 1 = right, 2 = middle; without meaning for a move
  bool control = false;
  bool shift = false;
  double x = 0;  ///< share of the picture's width, from the left
  double y = 0;  ///< share of its height, from below
  /// The line of sight through that point: from the camera, unit direction.
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitX();
};

/// Sees every input first, moves without a button as well.
/// @return true where it uses the input: then neither camera nor picking see it. Who uses a press
/// gets all that follows up to the release.
using MouseHook = std::function<bool(const MouseInput& input)>;

}  // namespace mjarm::view
