#pragma once

#include <span>
#include <string>
#include <string_view>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Which arm of a model is meant.
struct ArmOptions {
  /// Site or body to use as tool frame (a site goes before a body of the same name; `#ID` names a
  /// body without a name); empty = the only sensible one.
  std::string tip;
};

/// Finds the arm: the chain of hinge and slide joints from the world to the tip, without gripper
/// fingers. Limits that the file lacks come from a small table of known robots, else from stated
/// defaults (see limits_table.hpp). Joints off the chain keep their `home` or initial value; an arm
/// on a free base starts after the free joint. Arm::overlapping is what overlaps, or touches to 0.1
/// mm, at `home` and in each of 64 postures that are drawn within the ranges of all hinges and
/// slides, with no free or ball joint between the two: nothing that merely lies somewhere is part
/// of a design.
///
/// The gripper is what one actuator beyond the last joint moves, or two actuators, one for each of
/// two fingers of one kind on one body; a hand of more is none.
///
/// Without `tip` the arm is the longest chain without fingers (joints with such a name, joints
/// coupled with a neighbour, branches shorter than their trunk), and the tip is the frame rigidly
/// after its last joint that bears a usual name (`hand_tcp`, `attachment_site`, `tool0`, ...), else
/// the only site there, else the last body.
/// @return an error that lists the choices where two arms or several tips are possible.
[[nodiscard]] Result<Arm> find_arm(const Model& model, const ArmOptions& options = {});

/// Pose of the named site or body in the world at the model's full configuration `qpos` (nq,).
/// @return an error with the nearest name.
[[nodiscard]] Result<Pose> frame_pose(const Model& model, std::string_view frame,
                                      std::span<const double> qpos);
/// The same in home_configuration().
[[nodiscard]] Result<Pose> frame_pose(const Model& model, std::string_view frame);

}  // namespace mjarm
