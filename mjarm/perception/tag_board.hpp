#pragma once

#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/perception/find_errc.hpp"
#include "mjarm/perception/tag_detector.hpp"
#include "mjarm/render/rgbd_frame.hpp"

namespace mjarm::perception {

/// A tag of a board.
struct BoardTag {
  int id = 0;
  double size = 0;  ///< [m] edge of the black square, > 0
  Pose X_BT = {};   ///< the tag on the board, as tag_corners() has its frame
};

/// A corner of a board that is seen.
struct BoardCorner {
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();    ///< [m] on the board
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< [px]
};

/// The corners of all tags of a board that are seen, those of one tag after the other. Tags that
/// are seen twice are left out.
[[nodiscard]] std::vector<BoardCorner> board_corners(std::span<const BoardTag> board,
                                                     std::span<const SeenTag> seen);

/// Where a board is, as a camera sees it, without depth.
struct BoardPose {
  Pose X_CB = {};
  double residual = 0;  ///< [px] root of the mean squared distance of corners
};

/// The pose in which the board's corners are nearest to those seen: Gauss and Newton from both
/// poses that a single tag leaves open.
/// @param corners  of at least one tag, as board_corners() gives them
/// @return not_seen without corners; ambiguous where both poses explain them: use more tags, or
/// look
///         at them askew.
[[nodiscard]] Result<BoardPose, FindErrc> board_pose(std::span<const BoardCorner> corners,
                                                     const render::CameraIntrinsics& lens);

}  // namespace mjarm::perception
