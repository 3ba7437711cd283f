#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::program {

/// A posture from which an arm can move its tool in every direction.
struct StartPosture {
  JointVec q;             ///< [rad or m] shape (dof,)
  bool is_home = false;   ///< the arm's own `home`
  double dexterity = 0;   ///< see dexterity(); 0 at a singularity
  double limit_room = 0;  ///< [rad or m] from the nearest limit, of the joint or of what its servo
                          ///< can be told; at most half a turn
};

/// What makes a posture good to start from. Every default is usable as is.
struct StartOptions {
  double least_dexterity = 0.08;   ///< of `home`, >= 0
  double least_limit_room = 0.05;  ///< [rad or m] of `home`, >= 0
  int draws = 2000;                ///< random postures looked at, >= 0
  int postures = 12;               ///< most that are returned besides `home`, >= 0
};

/// Smallest singular value of the Jacobian at `q`, with lengths as shares of the arm's; of the rows
/// of position alone where the arm has fewer than six joints. 0 where a direction is lost (of three
/// directions for fewer than six joints, else of six).
[[nodiscard]] double dexterity(const Arm& arm, std::span<const double> q);

/// Postures to start from, the best first: `home` where it is fit, then bent ones out of random
/// draws that are well inside the limits and what the servos can be told (ctrlrange), dexterous,
/// with the tool above the floor, and mutually different. Same arm and `rng`, same postures.
/// @param valid  accepts or refuses a posture (contact); empty accepts all.
[[nodiscard]] std::vector<StartPosture> start_postures(
    const Arm& arm, const std::function<bool(std::span<const double> q)>& valid, Rng& rng,
    const StartOptions& options = {});

}  // namespace mjarm::program
