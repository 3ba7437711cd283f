#pragma once

#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/grip_check.hpp"
#include "mjarm/model/grip_trial_internal.hpp"
#include "mjarm/model/model.hpp"

/// What of a gripper lets go of what it holds.
namespace mjarm::detail {

/// What a hold depends on.
enum class GripSetting { cone, impratio, soft, slippery, condim, damping, slow };
inline constexpr int kGripSettings = 7;

/// A setting that costs something.
struct GripFault {
  GripSetting setting = GripSetting::cone;
  GripOutcome left;  ///< with all mended but this
};

/// A gripper measured on a cube.
struct GripDiagnosis {
  double edge = 0;  ///< [m] of the cube
  GripOutcome as_is;
  GripOutcome mended;  ///< the same as `as_is` where nothing is mended
  GripMend mend;
  bool creeps = false;               ///< as it is much more than mended
  std::vector<GripFault> faults;     ///< in the order of the settings
  std::vector<JawOverlap> overlaps;  ///< in the open hand, then once it has closed
};

/// Solver settings of a contact between a pad and a thing of MuJoCo's defaults.
struct PadContact {
  double solref = 0;    ///< [s] time constant, negative for a stiffness
  double solimp = 0;    ///< lowest impedance
  double friction = 0;  ///< of sliding
  int condim = 0;
};
[[nodiscard]] PadContact pad_contact(const mjModel& m, int geom);
[[nodiscard]] bool is_soft(const PadContact& pad);
[[nodiscard]] bool is_slippery(const PadContact& pad);
[[nodiscard]] bool is_flat(const PadContact& pad);  ///< of too few directions of friction

/// Damping of a joint by the actuator of the gripper [N m s/rad or N s/m].
[[nodiscard]] double drive_damping(const mjModel& m, const Gripper& gripper, int joint);

/// Closes the gripper on a cube, as it is and with what is usual for a firm hold, and finds which
/// of that matters: each setting is left out by itself. About ten closings, each of at most 6000
/// steps.
/// @return not_available, with why, where there are no jaws or nothing can be held in them.
[[nodiscard]] Result<GripDiagnosis> diagnose_grip(const Model& model, const Arm& arm,
                                                  const LoadOptions& options);

}  // namespace mjarm::detail
