#pragma once

#include <optional>
#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/commands/render_options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/planning/problem_file.hpp"
#include "mjarm/session/plan_drawing.hpp"

namespace mjarm::app {

/// What is asked to be shown of a plan, as it stands on the command line.
struct PlanShowArguments {
  std::string picture, size, camera, quality, seconds;
  bool view = false;
  /// Whether anything is.
  [[nodiscard]] bool wanted() const { return view || !picture.empty(); }
};

/// Adds `--picture`, `--view`, `--size`, `--camera`, `--quality` and `--seconds`, bound to
/// `arguments`.
void add_plan_show_options(CLI::App& app, PlanShowArguments& arguments);

/// What can be shown. Without a picture, a window.
struct PlanShow {
  std::optional<PictureOptions> picture = {};
  int width = 1280;         ///< [px] of the window
  int height = 800;         ///< [px] of the window
  std::string camera = {};  ///< for choose_camera(); empty = chosen for the path
  std::optional<RenderQuality> quality = {};
  double seconds = 0;  ///< [s] after which the window closes; 0 = never
};

/// Reads the options. @return none where nothing is to be shown; a usage error that names the one
/// that is wrong.
[[nodiscard]] Result<std::optional<PlanShow>> read_plan_show(const PlanShowArguments& arguments);

/// Draws a planned path into a file, or opens a window on it and returns when that is closed. Tells
/// the tightest place. Called from the main thread.
/// @return impossible without a display, not_available without OpenGL.
[[nodiscard]] Result<void> show_plan(const PlanShow& show, const session::PlanSubject& subject);

/// The same for a robot that is known as spheres only: the arm is drawn as a chain of rods. An arm
/// without a tool gets one at its outermost spheres.
/// @return what sphere_model() cannot draw, besides.
[[nodiscard]] Result<void> show_plan_of_spheres(const PlanShow& show, const FastRobot& robot,
                                                const PlanProblem& problem,
                                                const PlannedPath& path);

}  // namespace mjarm::app
