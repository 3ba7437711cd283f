#pragma once

#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Which arm of a model is meant.
struct ArmOptions {
  std::string tip;  ///< site or body to use as tool frame; empty = the only sensible one
};

/// Finds the arm: the chain of hinge and slide joints from the world to the tip, without gripper
/// fingers. Limits that the file lacks come from a small table of known robots, else from stated
/// defaults. Joints off the chain keep their `home` or initial value.
/// @return an error that lists the choices where two arms or several tips are possible.
[[nodiscard]] Result<Arm> find_arm(const Model& model, const ArmOptions& options = {});

/// Pose of the named site or body in the world at the model's full configuration `qpos` (nq,).
/// @return an error with the nearest name.
[[nodiscard]] Result<Pose> frame_pose(const Model& model, std::string_view frame,
                                      std::span<const double> qpos);

}  // namespace mjarm
