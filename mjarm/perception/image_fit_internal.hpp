#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "mjarm/perception/depth_scene_internal.hpp"
#include "mjarm/perception/raster_internal.hpp"

namespace mjarm::perception {

/// A part of the picture, perhaps coarser, with one cluster in it.
struct FitView {
  /// What a pixel may be compared with.
  enum Kind : std::uint8_t {
    outside,  ///< nothing: it is outside of the picture
    none,     ///< nothing: it was not measured
    table,    ///< the table, or what is so near to it that noise hides which
    cluster,  ///< the cluster
    other,    ///< something else, which may hide what is looked for
  };
  render::CameraIntrinsics lens;
  double scale = 1;            ///< [px] of the picture between two pixels of the view
  std::vector<float> inverse;  ///< [1/m] measured
  std::vector<float> table_inverse;
  std::vector<Kind> kind;
  double middle = 0;  ///< [1/m] mean of the cluster
  double sigma = 0;   ///< [1/m] of a pixel, with what surfaces are off their model
  int cluster_pixels = 0;
};

/// The box x0..x1, y0..y1 [px] (it may reach outside) of a picture, with at most so many pixels a
/// side.
[[nodiscard]] FitView view_of(const DepthScene& scene, int cluster, const Cluster& box,
                              int max_side);

/// How far a drawing is off at each pixel, in sigma, at most `limit`: the drawing stands on the
/// table, and things may stand in front of it.
void residuals_of(const FitView& view, const std::vector<float>& drawn, float limit,
                  std::vector<float>& out);
/// Half the sum of their squares.
[[nodiscard]] double cost_of(const std::vector<float>& residuals);

/// Draws what is looked for, with the numbers `x`, into a cleared raster.
/// @return one more residual, in sigma: how far it is from what may be; 0 where it may be.
using DrawWith = std::function<float(const Eigen::VectorXd& x, Raster& raster)>;

/// How an image fit is done.
struct FitLevel {
  float limit = 4;       ///< [sigma] most that a pixel counts
  Eigen::VectorXd step;  ///< (n,) what is changed to see the slope: about a pixel
  int steps = 8;
};

struct ImageFit {
  Eigen::VectorXd x;  ///< (n,)
  double cost = 0;
  Eigen::MatrixXd information;  ///< (n, n) second derivative of the cost there
};

/// Moves `x` to where the drawing fits best: Gauss and Newton, damped, with slopes by drawing. As
/// steps are as large as a pixel, outlines pull as well as depth: where a pixel changes hands
/// within a step, its residual does too.
[[nodiscard]] ImageFit fit_image(const FitView& view, const DrawWith& draw, Eigen::VectorXd x,
                                 const FitLevel& level, Raster& raster);

}  // namespace mjarm::perception
