#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/path/clearance.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// How the joints are moved so that a log tells much. Every default is usable as is.
struct ExcitationOptions {
  double seconds = 20;     ///< [s] 5 .. 120
  std::uint64_t seed = 1;  ///< same robot, start and seed, same motion
  double share = 0.4;      ///< of the joints' velocity and acceleration limits, (0, 1]
  double reach = 1.2;      ///< [rad or m] farthest from the start, > 0
  int tries = 30;          ///< random motions of each size, >= 1
  /// Whether the arm may stand at `q` (dof,); empty: anywhere within its limits.
  std::function<bool(std::span<const double> q)> valid = {};
};
inline constexpr double kLeastExcitation = 5;   ///< [s]
inline constexpr double kMostExcitation = 120;  ///< [s]

/// Every joint to and fro about `q_start` (dof,) by a Fourier series of its own, at rest there at
/// both ends (J. Swevers et al., IEEE Trans. Robotics and Automation 13 (1997) 730): of random
/// coefficients the motion whose equations for friction, links and payload are best conditioned;
/// smaller ones where none of a size is free of contact.
/// @return bad_input for a time beyond its range, impossible where no motion is valid.
[[nodiscard]] Result<Trajectory> excitation(const Model& model, const Arm& arm,
                                            const JointVec& q_start,
                                            const ExcitationOptions& options = {});

/// [m] That free_excitation() keeps from everything.
inline constexpr double kExcitationClearance = 0.01;

/// The same on which nothing is touched, by what `clearance` measures; empty: it looks at nothing.
/// @return impossible also where something overlaps between the moments that were looked at.
[[nodiscard]] Result<Trajectory> free_excitation(const Model& model, const Arm& arm,
                                                 const JointVec& q_start,
                                                 const ClearanceCheck& clearance,
                                                 const ExcitationOptions& options = {});

}  // namespace mjarm
