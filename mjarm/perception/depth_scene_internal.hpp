#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/perception/depth_model_internal.hpp"
#include "mjarm/perception/plane.hpp"
#include "mjarm/render/rgbd_frame.hpp"

namespace mjarm::perception {

/// What a pixel shows; 0 and above is the number of a cluster.
enum PixelLabel : std::int16_t {
  kNothing = -1,  ///< no depth
  kTable = -2,
  kBeyond = -3,  ///< below the table, beside it, or taken out
  kSpeck = -4,   ///< above the table, in too small a piece
};

/// Pixels of one piece of surface above the table.
struct Cluster {
  int pixels = 0;
  double middle = 0;                   ///< [1/m] mean of 1/z
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< [px] the box around them, all inside
};

/// What depth shows before anything is recognised.
struct DepthScene {
  render::CameraIntrinsics lens;
  Pose X_WC;
  DepthModel model;
  std::vector<float> inverse;       ///< [1/m] (height * width,), 0: nothing measured
  std::vector<std::int16_t> label;  ///< (height * width,)
  std::optional<Plane> table;
  Eigen::Vector3d table_a = Eigen::Vector3d::Zero();  ///< 1/z of the table is table_a . ray
  std::vector<Cluster> clusters;

  /// [1/m] of the table in a pixel; 0 where it is not seen, or there is none.
  [[nodiscard]] float table_at(const Eigen::Vector3d& ray) const {
    return std::max(0.0F, static_cast<float>(table_a.dot(ray)));
  }
};

/// @param table  the plane on which things stand; without one the largest level plane is looked for
///               (M. Fischler and R. Bolles, 1981).
[[nodiscard]] DepthScene depth_scene(const render::RgbdFrame& frame, const DepthModel& model,
                                     const std::optional<Plane>& table, Rng& rng);

/// Takes the pixels that show what is known to stand above the table out of clusters, and makes
/// these anew.
/// @param known  [1/m] (lens.height * lens.width,) 0 where nothing is
void leave_out(DepthScene& scene, const std::vector<float>& known);

/// Takes the pixels of clusters in which `drawn` stands where depth is (and two pixels about them)
/// out of them.
/// @param drawn  [1/m] (lens.height * lens.width,) 0 where nothing is
void take_out(DepthScene& scene, const std::vector<float>& drawn);

/// Makes clusters anew of all pixels that are in one, and of specks.
/// @param jump   [m] in depth between neighbours that still belong together, beside the noise
/// @param color  of the same pixels: where its hue changes a cluster ends; null: depth alone counts
void gather(DepthScene& scene, double jump, const render::Image* color = nullptr);
/// What a smooth surface may fall from one pixel to the next.
inline constexpr double kSmoothJump = 0.004;  // [m]

}  // namespace mjarm::perception
