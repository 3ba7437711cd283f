#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/render/rgbd_frame.hpp"

namespace mjarm::perception {

/// @return bad_input unless picture, depth and intrinsics are of one size, and all finite.
[[nodiscard]] Result<void> check_frame(const render::RgbdFrame& frame);

}  // namespace mjarm::perception
