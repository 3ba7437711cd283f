#pragma once

#include "apps/mjarm/view/plan_drawing.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::app {

/// A view of a planned path: all of the arm on its way and the obstacles within its reach are in
/// the picture, and of the directions tried it is the one from which obstacles hide least of arm
/// and path.
/// @param aspect  width of the picture by its height, > 0.
[[nodiscard]] CameraView plan_view(const PlanSubject& subject, const PlanDrawing& drawing,
                                   double aspect);

/// The solids, by index, that hide more than a little of arm and path from there.
[[nodiscard]] std::vector<int> hiding_solids(const PlanSubject& subject, const PlanDrawing& drawing,
                                             const CameraView& view);

}  // namespace mjarm::app
