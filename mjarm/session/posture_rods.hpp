#pragma once

#include "mjarm/model/arm.hpp"
#include "mjarm/render/overlay.hpp"

namespace mjarm::session {

/// Appends the arm at `q`, shape (dof,), as rods from joint to joint and to the tool: the arm once
/// more would hide what it passes.
/// @param radius  [m] of the rods, > 0.
void add_posture_rods(render::Overlay& overlay, const Arm& arm, const JointVec& q,
                      const render::Rgba& color, double radius);

}  // namespace mjarm::session
