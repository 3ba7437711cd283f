#pragma once

#include <array>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/perception/find_errc.hpp"
#include "mjarm/perception/tag_detector.hpp"
#include "mjarm/render/rgbd_frame.hpp"

namespace mjarm::perception {

/// The corners of a tag in its own frame T, in the order of SeenTag: the origin in the middle, x to
/// the right, y up, z out of the picture towards who looks at it.
/// @param size  [m] edge of the black square, > 0
[[nodiscard]] std::array<Eigen::Vector3d, 4> tag_corners(double size);

/// Where a tag is, as an RGB-D camera sees it.
struct TagPose {
  Pose X_CT = {};       ///< the tag in the camera's frame
  double residual = 0;  ///< [px] root of the mean squared distance of corners
};

/// Pose of a tag from its corners and from the plane that depth shows on it. Corners alone leave
/// the tilt of a small tag open by degrees, and twofold where it faces the camera; depth tells it.
/// @param size         [m] edge of the black square, > 0
/// @param depth_sigma  [m] standard deviation of depth 0.5 m away, as RgbdOptions has it
/// @return wrong_size; no_depth where less than half of the tag has depth; disagrees where that is
///         no plane.
[[nodiscard]] Result<TagPose, FindErrc> tag_pose(const SeenTag& tag, double size,
                                                 const render::RgbdFrame& frame,
                                                 double depth_sigma = 0.001);

}  // namespace mjarm::perception
