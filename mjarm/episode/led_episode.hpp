#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::episode {

/// How things stand at one time while somebody leads an arm.
struct LedSample {
  Snapshot world;
  JointVec q_ref;   ///< (dof,) [rad or m] where the arm is led
  double grip = 0;  ///< 0 open to 1 closed, as commanded
};

/// What an episode that somebody made by leading an arm says of itself.
struct LedEpisode {
  std::string robot;     ///< as the user named it
  std::string language;  ///< the task in words, of any language
  int fps = 20;          ///< [1/s] rows
};

/// Writes an episode into `folder` under the first number that is free there, in one step: an
/// archive of the task "teleop" with all the columns of a demonstration (docs/data.md), without
/// pictures and plan. The folder is made.
/// @param samples  at least one, of worlds of the robot's model.
/// @return the file; bad_input where samples do not fit; else what writing says.
[[nodiscard]] Result<std::filesystem::path> keep_led_episode(const std::filesystem::path& folder,
                                                             const Robot& robot,
                                                             const LedEpisode& about,
                                                             std::span<const LedSample> samples);

}  // namespace mjarm::episode
