#pragma once

#include <string>
#include <vector>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/view/controls.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::app {

/// How a window is drawn, as the user wrote it.
struct WindowArguments {
  std::string size, camera, quality;
};
/// Adds `--size`, `--camera` and `--quality`, bound to `arguments`.
void add_window_options(CLI::App& app, WindowArguments& arguments);
/// Reads size and quality; the camera is set_camera()'s, once there is a model.
/// @param out  with what the user has no say in.
/// @return a usage error that names the option that is wrong.
[[nodiscard]] Result<view::WindowOptions> read_window_options(const WindowArguments& arguments,
                                                              view::WindowOptions out);

/// The end of a help in one language: examples, and below them what each key and button does.
/// @param rows  as view::control_help(), which tells them in the language in use.
[[nodiscard]] std::string examples_and_controls(Language language, Msg examples, Msg heading,
                                                std::vector<view::ControlHelp> (*rows)());

}  // namespace mjarm::app
