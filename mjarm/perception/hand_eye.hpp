#pragma once

#include <span>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/perception/tag_board.hpp"
#include "mjarm/render/rgbd_frame.hpp"

namespace mjarm::perception {

/// What a camera saw of a board, and where the arm had its tool.
struct HandEyeView {
  Pose X_WT = {};                         ///< the tool in the world (or the arm's base)
  std::vector<BoardCorner> corners = {};  ///< as board_corners() gives them; empty: not seen
};

/// Where the camera is.
enum class CameraMount {
  wrist,  ///< it moves with the tool, the board stands still (eye in hand)
  fixed,  ///< it stands still, the board moves with the tool (eye to hand)
};

/// Why a calibration was not done.
enum class HandEyeErrc {
  too_few_views,   ///< fewer than three
  board_not_seen,  ///< by fewer than three of them
  one_axis,        ///< the tool is turned about one axis only, or not at all
  contradiction,   ///< views and poses of the tool do not fit together
};
/// One sentence, in the language in use.
[[nodiscard]] std::string describe(HandEyeErrc code);

/// A camera's place.
struct HandEye {
  Pose X_PC = {};  ///< the camera on its carrier P: the tool for `wrist`, the world for `fixed`
  Pose X_QB = {};  ///< the board on the other one: the world for `wrist`, the tool for `fixed`
  int views = 0;   ///< that saw the board
  double residual = 0;  ///< [px] root of the mean squared distance of corners over all views
};

/// Where a camera is, from views of a board. First from the turns alone (F. Park and B. Martin,
/// Robot sensor calibration: solving AX = XB on the Euclidean group, IEEE T-RA 10 (1994) 717), then
/// by the distances of all corners in all pictures, over both poses at once.
/// @param views  at least 3, usually 20, which turn the tool about two axes or more
/// @return the reason; `contradiction` where corners are off by more than 3 px, root mean square.
[[nodiscard]] Result<HandEye, HandEyeErrc> calibrate_hand_eye(std::span<const HandEyeView> views,
                                                              CameraMount mount,
                                                              const render::CameraIntrinsics& lens);

}  // namespace mjarm::perception
