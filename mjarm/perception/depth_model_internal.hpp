#pragma once

#include <algorithm>
#include <cmath>

#include "mjarm/render/rgbd.hpp"

namespace mjarm::perception {

/// The room computes with inverse depth 1/z [1/m], larger where things are nearer: the noise of
/// depth, which grows with the square of z, is the same everywhere in it, and a plane is linear in
/// the pixel's row and column.
struct DepthModel {
  /// @param depth_sigma  [m] as RgbdOptions has it. Less than a tenth of a millimetre is taken for
  ///                     that, as nothing is rendered, or made, more exactly.
  explicit DepthModel(double depth_sigma)
      : sigma(std::max(depth_sigma, 1e-4) / (render::kSigmaDepth * render::kSigmaDepth)) {}
  double sigma;  ///< [1/m] standard deviation of 1/z

  /// [1/m] so much less of depth near 1/z = `inverse`.
  [[nodiscard]] static double from_metres(double metres, double inverse) {
    return metres * inverse * inverse;
  }
};

/// [1/m], 0 where nothing was measured.
[[nodiscard]] inline float inverse_depth(float z) { return std::isfinite(z) && z > 0 ? 1 / z : 0; }

}  // namespace mjarm::perception
