#pragma once

#include <Eigen/Core>
#include <optional>

#include "mjarm/core/pose.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/view/mailbox.hpp"

namespace mjarm::view {

/// Where the user drags the target.
struct TargetDrag {
  Pose X_WT;
  bool held = true;  ///< false once he lets go
  long number = 0;   ///< of all drags, rising
};

/// How the target is to be shown.
struct TargetLook {
  bool shown = false;
  Pose X_WT = {};
  std::optional<Eigen::Matrix3d> R_WG = {};  ///< directions of the handles; none = the target's
  render::Rgba color = {};                   ///< of the ball
  long number = 0;                           ///< of the last drag that this is the answer to
};

/// What passes between the thread that draws the target and that of the simulation. Neither waits.
struct TargetLink {
  Queue<TargetDrag> drags;    ///< from the window
  Mailbox<TargetLook> looks;  ///< to the window
};

}  // namespace mjarm::view
