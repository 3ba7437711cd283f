#pragma once

#include <functional>

#include "mjarm/render/overlay.hpp"
#include "mjarm/view/ray.hpp"

namespace mjarm::view {

/// Adds what depends on how the window sees the world: called for every frame after the mouse has
/// moved the camera, in the main thread.
/// @param eye      with which the frame is drawn.
/// @param overlay  of the frame.
using DrawHook = std::function<void(const Eye& eye, render::Overlay& overlay)>;

}  // namespace mjarm::view
