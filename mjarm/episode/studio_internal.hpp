#pragma once

#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/model/jaws.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::episode {

inline constexpr double kAbove = 0.12;  // [m] reach: of the jaws above the middle of an object

/// The scene of a shipped robot in which the tasks are.
[[nodiscard]] const char* scene_file(const std::string& robot);

/// X_TJ of the middle between the jaws: they close along x and approach along z.
[[nodiscard]] Pose jaws_frame(const Jaws& jaws);

/// Puts the arm and the objects of `sim` where the scene has them, at rest.
/// @return the numbers of the objects' bodies, in the order of the scene.
[[nodiscard]] std::vector<int> place_scene(const Robot& robot, const DrawnScene& scene, Sim& sim);

/// Command of the gripper, 0 open to 1 closed.
[[nodiscard]] double grip_command(const Gripper& gripper, const Sim& sim);

/// Draws the scene in its looks, as every picture of an episode is drawn.
[[nodiscard]] Result<render::OffscreenRenderer> open_pictures(const Robot& robot,
                                                              const EpisodeOptions& options,
                                                              const DrawnScene& scene);

}  // namespace mjarm::episode
