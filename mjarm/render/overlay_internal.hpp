#pragma once

#include <mujoco/mujoco.h>

#include <cstddef>

#include "mjarm/render/overlay.hpp"

namespace mjarm {

/// Most geoms that `overlay` needs in a scene.
[[nodiscard]] std::size_t geoms_of(const Overlay& overlay);

/// Adds what `overlay` holds to the geoms of `scene`, which has room for it.
void add_overlay(const Overlay& overlay, mjvScene& scene);

}  // namespace mjarm
