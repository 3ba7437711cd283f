#pragma once

#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::episode {

/// Puts the arm, the joints and the objects of `sim` where the scene has them, at rest.
/// @return the numbers of the objects' bodies, in the order of the scene.
[[nodiscard]] std::vector<int> place_scene(const Robot& robot, const DrawnScene& scene, Sim& sim);

/// Command of the gripper, 0 open to 1 closed; 0 where there is none.
[[nodiscard]] double grip_command(const Arm& arm, const Sim& sim);

/// Draws the scene in its looks, as every picture of an episode is drawn.
[[nodiscard]] Result<render::OffscreenRenderer> open_pictures(const Robot& robot,
                                                              const EpisodeOptions& options,
                                                              const DrawnScene& scene);

}  // namespace mjarm::episode
