#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"

namespace mjarm::clone {

/// What a cloned policy knows of a scene: no picture, but where things are.
struct Observed {
  Pose X_WT;                                          ///< of the tool, as the controller was told
  double grip = 0;                                    ///< command, 0 open to 1 closed
  std::vector<Pose> objects;                          ///< X_WB, in the order of the drawn scene
  std::size_t target = 0;                             ///< the object that is asked for
  Eigen::Vector3d p_place = Eigen::Vector3d::Zero();  ///< [m] DrawnScene::p_goal
};

/// What it answers: where the tool and the gripper's command are to be one row later.
struct Answer {
  Pose X_WT;
  double grip = 0;
};

inline constexpr int kActions = 7;  ///< numbers of an answer

/// Numbers of an observation of a scene with so many objects.
[[nodiscard]] int observation_size(std::size_t objects);

/// As numbers about 1: where the tool is in the world; target, place and the others as the tool
/// sees them, near ones finer; the gripper; which object is asked for.
/// @param out (observation_size(),)
void write_observation(const Observed& seen, std::span<float> out);

/// An answer as seen from there: the way of the tool in its own frame, in units of 5 cm and 0.2
/// rad, and of the gripper's command, in units of 0.2.
/// @param out (kActions,)
void write_answer(const Observed& seen, const Answer& answer, std::span<float> out);
/// The opposite.
[[nodiscard]] Answer read_answer(const Observed& seen, std::span<const float> numbers);

}  // namespace mjarm::clone
