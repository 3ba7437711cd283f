#pragma once

#include <mujoco/mujoco.h>

#include "mjarm/model/grip_check.hpp"

/// What a GripMend changes in a model.
namespace mjarm::detail {

inline constexpr double kMendedImpratio = 30;
inline constexpr int kMendedCondim = 6;
inline constexpr int kLeastCondim = 4;           ///< below it nothing resists twisting
inline constexpr double kMendedSolref = 0.004;   ///< [s]
inline constexpr double kSlowestSolref = 0.005;  ///< [s] above it a pad gives way
inline constexpr double kMendedSolimp = 0.99;
inline constexpr double kLeastSolimp = 0.985;  ///< below it a pad gives way
inline constexpr double kMendedFriction = 1;
inline constexpr double kLeastFriction = 0.5;  ///< below it a pad is slippery

/// Contact settings of a geom, of a compiled model or of a description.
struct PadSettings {
  int& condim;
  int& priority;
  double* friction;
  mjtNum* solref;
  mjtNum* solimp;
};
void mend_pad(const GripMend& mend, PadSettings pad);

/// Writes `mend` into a compiled model. What MuJoCo derives from armature is left to the caller.
void apply(const GripMend& mend, mjModel& m);

/// Writes `mend` into the description that `m` was compiled from.
/// @return false where the two do not fit together.
[[nodiscard]] bool apply(const GripMend& mend, const mjModel& m, mjSpec& spec);

}  // namespace mjarm::detail
