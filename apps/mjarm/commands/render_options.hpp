#pragma once

#include <optional>
#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/session/picture.hpp"

namespace mjarm::app {

/// What picture or video is asked for, as it stands on the command line.
struct PictureArguments {
  std::string out, size, camera, quality, fps, seconds;
  Replace replace = {};
};

/// Adds `--out`, `--overwrite`, `--size`, `--camera`, `--quality`, `--fps` and `--seconds`, bound
/// to `arguments`.
void add_picture_options(CLI::App& app, PictureArguments& arguments);

/// A picture or a video that can be made, and of what.
struct PictureRequest : session::PictureOptions {
  std::string camera = {};             ///< for `choose_camera`
  std::optional<double> seconds = {};  ///< [s]
};

/// Reads the options. @return a usage error that names the one that is wrong.
[[nodiscard]] Result<PictureRequest> read_picture_options(const PictureArguments& arguments);

/// The camera meant by `words`: the name of one of the model's, or azimuth, elevation, distance and
/// maybe the point looked at; empty = `overview` where the model has it, else its own view.
/// @return bad_input with the nearest name, or a usage error.
[[nodiscard]] Result<render::Camera> choose_camera(const Model& model, const std::string& words);

}  // namespace mjarm::app
