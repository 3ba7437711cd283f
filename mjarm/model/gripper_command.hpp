#pragma once

#include <cstddef>
#include <span>

#include "mjarm/model/arm.hpp"

namespace mjarm {

/// What brings a drive as far closed as `grip` says, 0 open to 1 closed; exact at both ends.
[[nodiscard]] inline double ctrl_for_grip(const GripperDrive& drive, double grip) {
  return grip == 1 ? drive.ctrl_closed
                   : drive.ctrl_open + grip * (drive.ctrl_closed - drive.ctrl_open);
}

/// Writes the command of each drive of a gripper.
/// @param ctrl  (nu,) of the whole model.
inline void set_grip(const Gripper& gripper, double grip, std::span<double> ctrl) {
  for (const GripperDrive& drive : gripper.drives) {
    ctrl[static_cast<std::size_t>(drive.id)] = ctrl_for_grip(drive, grip);
  }
}

/// How far closed `ctrl` drives a gripper: the mean of its drives, beyond 0 and 1 where `ctrl` lies
/// beyond both ends.
/// @param ctrl  (nu,) of the whole model.
[[nodiscard]] inline double grip_of(const Gripper& gripper, std::span<const double> ctrl) {
  double sum = 0;  // no -0
  for (const GripperDrive& drive : gripper.drives) {
    sum += (ctrl[static_cast<std::size_t>(drive.id)] - drive.ctrl_open) /
           (drive.ctrl_closed - drive.ctrl_open);
  }
  return sum / static_cast<double>(gripper.drives.size());
}

}  // namespace mjarm
