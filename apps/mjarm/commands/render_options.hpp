#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/offscreen.hpp"

namespace mjarm::app {

/// What picture or video is asked for, as it stands on the command line.
struct PictureArguments {
  std::string out, size, camera, quality, fps, seconds;
};

/// Adds `--out`, `--size`, `--camera`, `--quality`, `--fps` and `--seconds`, bound to `arguments`.
void add_picture_options(CLI::App& app, PictureArguments& arguments);

/// A picture or a video that can be made.
struct PictureOptions {
  std::filesystem::path out;
  bool video = false;
  int width = 1280;                           ///< [px]
  int height = 720;                           ///< [px]
  std::string camera = {};                    ///< for `choose_camera`
  std::optional<RenderQuality> quality = {};  ///< default: as `offscreen_options` chooses
  double fps = 30;                            ///< [1/s]
  std::optional<double> seconds = {};         ///< [s]
};

/// Reads the options. @return a usage error that names the one that is wrong.
[[nodiscard]] Result<PictureOptions> read_picture_options(const PictureArguments& arguments);

/// How to draw: without a quality asked for, high; low for a video without a GPU.
[[nodiscard]] OffscreenOptions offscreen_options(const PictureOptions& options);

/// The camera meant by `words`: the name of one of the model's, or azimuth, elevation, distance and
/// maybe the point looked at; empty = `overview` where the model has it, else its own view.
/// @return bad_input with the nearest name, or a usage error.
[[nodiscard]] Result<Camera> choose_camera(const Model& model, const std::string& words);

}  // namespace mjarm::app
