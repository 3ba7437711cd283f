#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/perception.hpp"
#include "mjarm/perception/check_frame_internal.hpp"

namespace mjarm::perception {

Result<void> check_frame(const render::RgbdFrame& frame) {
  const render::CameraIntrinsics& lens = frame.intrinsics;
  const render::Image& color = frame.color;
  const std::size_t pixels = static_cast<std::size_t>(std::max(0, lens.width)) *
                             static_cast<std::size_t>(std::max(0, lens.height));
  if (pixels == 0 || color.width != lens.width || color.height != lens.height ||
      color.rgb.size() != 3 * pixels || frame.depth.size() != pixels) {
    return fail(Errc::bad_input, text(msg::perception_bad_frame, lens.width, lens.height,
                                      color.width, color.height, frame.depth.size()));
  }
  const bool sound = lens.fx > 0 && lens.fy > 0 &&
                     std::isfinite(lens.fx + lens.fy + lens.cx + lens.cy + frame.X_WC.p.sum() +
                                   frame.X_WC.R.sum());
  if (!sound) return fail(Errc::bad_input, text(msg::perception_bad_intrinsics));
  return {};
}

}  // namespace mjarm::perception
