#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

/// [s] within which a contact is to be noticed once it has kBumpForce, and that force [N].
inline constexpr double kBumpTime = 0.02, kBumpForce = 20;

/// A moment of a run round a bump, for the plot.
struct BumpMoment {
  double time = 0;                  ///< [s] since the force passed kBumpForce
  double force = 0;                 ///< [N]
  double surprise = 0;              ///< of the observer
  std::vector<double> torque = {};  ///< (dof,) [N m] from outside, as the observer has it
  std::vector<double> speed = {};   ///< (dof,) [rad/s] true
};

/// What came of one run in a wrong world.
struct BumpRun {
  double seconds = 0;   ///< simulated
  long alarms = 0;      ///< before the bump
  double surprise = 0;  ///< the largest before the bump
  bool pushed = false;  ///< there was a bump; none where the motion itself touched something
                        ///< before, or a limit of torque cut it
  bool told = false;    ///< joints can tell it, see drive_bump()
  std::optional<double> delay = {};      ///< [s] from kBumpForce to the notice; before: 0
  std::optional<double> at_rest = {};    ///< [s] from the notice until the reference rests
  int link = -1, named = -1;             ///< joint whose link was pushed, and was named
  std::vector<BumpMoment> moments = {};  ///< of the 60 ms before and the 140 ms after
};

/// One run in a world that `seed` and `world` draw (draw_wrong_world(), ImperfectDrives): a
/// warm-up, then random joint moves under `control: robust`. With `push`, after 3 to 8 s the arm is
/// pushed at a random point of the surface of a random link, inwards and up to 27 deg aside, with
/// 25 to 80 N that rise within 4 to 20 ms, and it stops where it notices that.
///
/// Joints can tell a push where kBumpForce of it, on the arm with the joints that stand held still,
/// would within kBumpTime turn a joint by three steps of its encoder beyond where it was going; and
/// that joint turned by at least 0.05 rad/s all the 60 ms before, as dry friction holds a joint
/// that stands and hides any force within it.
/// @param seconds  [s] of motion where nothing pushes.
[[nodiscard]] Result<BumpRun> drive_bump(const Robot& known, const Robot& bare, std::uint64_t seed,
                                         std::uint64_t world, bool push, double seconds);

}  // namespace mjarm::app
