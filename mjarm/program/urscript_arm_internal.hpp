#pragma once

#include <span>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::program::detail {

/// Lengths [m] of an arm of Universal Robots in its Denavit-Hartenberg chain, as the controller
/// knows them: Universal Robots, "DH Parameters for calculations of kinematics and dynamics".
struct UrLengths {
  const char* name;
  double d1, a2, a3, d4, d5, d6;  ///< a2 and a3 count against the x axes
};

/// An arm of Universal Robots in a model.
struct UrArm {
  UrLengths lengths;  ///< nominal
  Pose X_WB;          ///< the controller's base frame in the world
  Pose X_JF;          ///< the flange (the controller's tool0) in the frame of the last joint
};

/// Pose X_BF of the flange at joint values `q`, shape (6,) [rad], by the nominal lengths.
[[nodiscard]] Pose ur_flange(const UrLengths& lengths, std::span<const double> q);

/// Recognises the arm by the names of its joints (with any prefix) and by its axes, which are
/// within 3 mm of the nominal ones. Base and flange are the frames of the model that bear their
/// names, else where the nominal lengths put them; the axes alone say how the base is turned.
/// @return an error that says what does not fit.
[[nodiscard]] Result<UrArm> find_ur_arm(const Model& model, const Arm& arm);

}  // namespace mjarm::program::detail
