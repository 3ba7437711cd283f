#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/picture_legend.hpp"

namespace mjarm::session {

/// A picture or a video that can be made.
struct PictureOptions {
  std::filesystem::path out;
  bool video = false;
  int width = 1280;                                   ///< [px]
  int height = 720;                                   ///< [px]
  std::optional<render::RenderQuality> quality = {};  ///< default: as `offscreen_options` chooses
  double fps = 30;                                    ///< [1/s]
  std::vector<render::LegendEntry> legend = {};       ///< drawn into every picture
  int strip = 0;  ///< so many pictures of a program in one, from its beginning to its end; 0: one
};

/// How to draw: without a quality asked for, high; low for a video without a GPU.
[[nodiscard]] render::OffscreenOptions offscreen_options(const PictureOptions& options);

/// The camera `overview` where the model has one, else the model's own view.
[[nodiscard]] render::Camera default_camera(const Model& model);

/// Pictures of one size as one: side by side, more than four in two rows.
[[nodiscard]] render::Image strip_of(const std::vector<render::Image>& pictures);

/// Adds the legend to a picture and writes it. @return the line to tell.
[[nodiscard]] Result<std::string> write_image(render::Image image, const PictureOptions& options);

/// Draws one picture and writes it. @return the line to tell.
[[nodiscard]] Result<std::string> write_picture(render::OffscreenRenderer& renderer,
                                                const PictureOptions& options,
                                                const Snapshot& snapshot,
                                                const render::Camera& camera,
                                                const render::Overlay& overlay);

}  // namespace mjarm::session
