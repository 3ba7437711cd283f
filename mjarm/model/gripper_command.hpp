#pragma once

#include "mjarm/model/arm.hpp"

namespace mjarm {

/// What drives a gripper as far closed as `grip` says, 0 open to 1 closed.
[[nodiscard]] inline double ctrl_for_grip(const Gripper& gripper, double grip) {
  return gripper.ctrl_open + grip * (gripper.ctrl_closed - gripper.ctrl_open);
}

/// How far closed `ctrl` drives a gripper, beyond 0 and 1 where `ctrl` lies beyond both ends.
[[nodiscard]] inline double grip_of_ctrl(const Gripper& gripper, double ctrl) {
  return 0.0 + (ctrl - gripper.ctrl_open) / (gripper.ctrl_closed - gripper.ctrl_open);  // no -0
}

}  // namespace mjarm
