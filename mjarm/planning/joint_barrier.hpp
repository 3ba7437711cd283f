#pragma once

#include <optional>
#include <span>

#include "mjarm/collision/link_balls.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// A value that a joint cannot pass, whatever the joints before it do: a link that it moves would
/// hit what stands. So it is with an upper arm that is to turn over through the floor.
struct JointBarrier {
  int joint = -1;     ///< one of the first three
  double at = 0;      ///< [rad or m]
  int link = -1;      ///< that hits, by index into the sphere set
  int obstacle = -1;  ///< what it hits there, by index among solids and clouds
};

/// Looks, with bounded work, for values between start and goal that a joint cannot pass. What the
/// joints before it can be is cut into parts, in each of which a ball inside of a link hits
/// something wherever in it they are.
/// @param goals  at least one, each of shape (dof,), as is `start`.
/// @return the barrier before the first goal, where there is one before each; none: nothing is
/// proved.
[[nodiscard]] std::optional<JointBarrier> find_barrier(const Arm& arm, const BallScene& scene,
                                                       std::span<const double> start,
                                                       std::span<const JointVec> goals);

}  // namespace mjarm
