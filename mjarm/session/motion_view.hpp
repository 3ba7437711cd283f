#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/sim/recorder.hpp"

namespace mjarm::session {

/// What a camera has to know of a motion: some postures on its way, the last one at its end, and
/// where the tool works [m]; and of a text the way it is read, a unit vector.
struct MotionOutline {
  std::vector<JointVec> postures = {};
  std::vector<Eigen::Vector3d> marks_W = {};
  std::optional<Eigen::Vector3d> right_W = {};
};
/// @param until  [s] since the beginning, when it is left.
[[nodiscard]] MotionOutline outline_of(const MotionPlan& plan,
                                       double until = std::numeric_limits<double>::infinity());
[[nodiscard]] MotionOutline outline_of(const Recorder& recorder);

/// The view of a picture of the end of a motion, or of a film of it: all that moves is in it, and
/// the arm hides as little as possible of where its tool works.
/// @param aspect  width of the picture by its height, > 0.
[[nodiscard]] render::CameraView motion_view(const Model& model, const Arm& arm,
                                             const MotionOutline& outline, bool film,
                                             double aspect = 16.0 / 9);

}  // namespace mjarm::session
