#pragma once

#include <mujoco/mujoco.h>

#include <cstddef>

#include "mjarm/render/overlay.hpp"

namespace mjarm::render {

/// Most geoms that `overlay` is given in a scene of the model, ghosts included.
[[nodiscard]] std::size_t geoms_of(const Overlay& overlay, const mjModel& m);

/// Adds what `overlay` holds, but for its ghosts, to the geoms of `scene`. Where that is more than
/// kMaxOverlayShapes or than there is room for, it is thinned evenly.
void add_overlay(const Overlay& overlay, mjvScene& scene);

}  // namespace mjarm::render
