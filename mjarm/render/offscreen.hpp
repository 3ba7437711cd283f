#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/render/gl_context.hpp"
#include "mjarm/render/image.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/scene.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::render {

/// How to draw. Every default is usable as is.
struct OffscreenOptions {
  int width = 1280;  ///< [px] 1 to 8192
  int height = 720;  ///< [px] 1 to 8192
  RenderQuality quality = RenderQuality::high;
  /// In the place of `quality` where pictures are computed by the processor.
  std::optional<RenderQuality> software_quality = {};
  GlChoice gl = GlChoice::automatic;
  /// 1 or 2: each pixel is the mean of so many by so many. Two smooth shadows as well, whose edges
  /// and specks no smoothing of OpenGL reaches; a picture takes up to four times as long.
  int supersampling = 1;
  bool sites = true;  ///< marks of the model, which no camera of a robot would see
};

/// Draws pictures of a model without a window. Each renderer is used by one thread at a time; it
/// holds its own copy of the simulated state and never touches a Sim.
class OffscreenRenderer {
 public:
  /// @return not_available where no OpenGL works on this machine, bad_input for a bad size.
  [[nodiscard]] static Result<OffscreenRenderer> create(const Model& model,
                                                        const OffscreenOptions& options = {});
  ~OffscreenRenderer();
  OffscreenRenderer(OffscreenRenderer&&) noexcept;
  OffscreenRenderer& operator=(OffscreenRenderer&&) noexcept;

  /// One picture of the model in the state `snapshot`; a snapshot without state draws the model as
  /// it starts. The same call on the same machine gives the same picture.
  /// @return bad_input where the camera or the snapshot does not fit the model, system where OpenGL
  ///         reports an error.
  [[nodiscard]] Result<Image> draw(const Snapshot& snapshot, const Camera& camera = {},
                                   const Overlay& overlay = {});

  /// Depth in the middle of each pixel, along the camera's line of sight, row by row from the top:
  /// shape (height * width,), [m]; 0 where nothing is.
  /// @param nearest  [m] > 0: what is nearer than this is cut away.
  /// @return usage unless made with RenderQuality::exact and one sample a pixel; else fails as
  ///         `draw` does.
  [[nodiscard]] Result<std::vector<float>> draw_depth(const Snapshot& snapshot,
                                                      const Camera& camera, double nearest);

  /// What was drawn last, for those who may include mujoco.h.
  [[nodiscard]] Scene& scene() noexcept;
  [[nodiscard]] const GlContext& gl() const noexcept;
  [[nodiscard]] RenderQuality quality() const noexcept;  ///< the one chosen

 private:
  struct Impl;
  explicit OffscreenRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::render
