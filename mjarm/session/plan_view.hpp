#pragma once

#include <vector>

#include "mjarm/render/camera.hpp"
#include "mjarm/session/plan_drawing.hpp"

namespace mjarm::session {

/// A view of a planned path with all of the arm on its way and what it goes round in the picture,
/// half from above and
/// across the line from start to goal, from the side of the base on which the path lies.
/// @param aspect  width of the picture by its height, > 0.
[[nodiscard]] render::CameraView plan_view(const PlanSubject& subject, const PlanDrawing& drawing,
                                           double aspect);

/// The solids, by index, that hide places of the tool on its way from there.
[[nodiscard]] std::vector<int> hiding_solids(const PlanSubject& subject, const PlanDrawing& drawing,
                                             const render::CameraView& view);

}  // namespace mjarm::session
