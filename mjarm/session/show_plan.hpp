#pragma once

#include <functional>
#include <optional>

#include "mjarm/core/result.hpp"
#include "mjarm/planning/problem_file.hpp"
#include "mjarm/session/picture.hpp"
#include "mjarm/session/plan_drawing.hpp"
#include "mjarm/view/recorded_run.hpp"

namespace mjarm::session {

/// How a plan is shown. Without a picture and without a record, in a window.
struct PlanShow {
  std::optional<PictureOptions> picture = {};
  view::RunKeeper record = {};  ///< of the arm going along it
  int width = 1280;             ///< [px] of the window
  int height = 800;             ///< [px] of the window
  /// The camera for the model that is shown; empty = chosen for the path.
  std::function<Result<render::Camera>(const Model&)> camera = {};
  std::optional<render::RenderQuality> quality = {};
  double seconds = 0;  ///< [s] after which the window closes; 0 = never
};

/// Draws a planned path into a file, or opens a window on it and returns when that is closed. Tells
/// the tightest place. Called from the main thread.
/// @return impossible without a display, not_available without OpenGL.
[[nodiscard]] Result<void> show_plan(const PlanShow& show, const PlanSubject& subject);

/// The same for a robot that is known as spheres only: the arm is drawn as a chain of rods. An arm
/// without a tool gets one at its outermost spheres.
/// @return what sphere_model() cannot draw, besides.
[[nodiscard]] Result<void> show_plan_of_spheres(const PlanShow& show, const FastRobot& robot,
                                                const PlanProblem& problem,
                                                const PlannedPath& path);

}  // namespace mjarm::session
