#pragma once

#include <memory>
#include <string_view>

#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/gl_context.hpp"
#include "mjarm/render/rgbd_frame.hpp"
#include "mjarm/render/scene.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::render {

/// Depth at which `depth_sigma` is told.
inline constexpr double kSigmaDepth = 0.5;  // [m]

/// What the camera is like. Every default is usable as is.
struct RgbdOptions {
  int width = 1280;            ///< [px] 1 to 8192
  int height = 720;            ///< [px] 1 to 8192
  double depth_sigma = 0.001;  ///< [m] standard deviation of depth 0.5 m away, >= 0; it grows with
                               ///< the square of depth, as that of two eyes does; 0: exact
  double nearest = 0.05;       ///< [m] what is nearer is not there, > 0
  double farthest = 10;        ///< [m] depth beyond it is not measured
  RenderQuality quality = RenderQuality::high;  ///< of the colours
  int supersampling = 1;                        ///< of the colours: 1 or 2
  GlChoice gl = GlChoice::automatic;
};

/// A camera of a model as an RGB-D camera: colours and depth without a window, and where it is. It
/// moves with what it is fixed to, and sees no sites. Used by one thread at a time.
class RgbdCamera {
 public:
  /// @param name  of a camera of the model; its field of view, or focal length and sensor, count.
  /// @return bad_input with the nearest name or the bad option; fails as OffscreenRenderer does.
  [[nodiscard]] static Result<RgbdCamera> create(const Model& model, std::string_view name,
                                                 const RgbdOptions& options = {});
  ~RgbdCamera();
  RgbdCamera(RgbdCamera&&) noexcept;
  RgbdCamera& operator=(RgbdCamera&&) noexcept;

  /// What it sees of the model in a state; a snapshot without state is the model as it starts.
  /// @param noise  depth's errors are drawn from it, independent from pixel to pixel; the same
  ///               generator gives the same frame.
  /// @return fails as OffscreenRenderer::draw does.
  [[nodiscard]] Result<RgbdFrame> look(const Snapshot& snapshot, Rng& noise);

 private:
  struct Impl;
  explicit RgbdCamera(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::render
