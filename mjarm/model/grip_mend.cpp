#include <algorithm>

#include "mjarm/model/grip_mend_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kMendedSolimp2 = 0.995;  // deep inside

}  // namespace

void mend_pad(const GripMend& mend, PadSettings pad) {
  if (mend.condim) pad.condim = std::max(pad.condim, kMendedCondim);
  if (mend.friction) pad.friction[0] = std::max(pad.friction[0], kMendedFriction);
  if (!mend.stiff || pad.solref[0] <= 0) return;  // those are stiffness and damping
  if (pad.priority < 1) {  // then the friction of what is held counts no more
    pad.priority = 1;
    pad.friction[0] = std::max(pad.friction[0], kMendedFriction);
  }
  pad.solref[0] = std::min<mjtNum>(pad.solref[0], kMendedSolref);
  pad.solref[1] = 1;
  pad.solimp[0] = std::max<mjtNum>(pad.solimp[0], kMendedSolimp);
  pad.solimp[1] = std::max<mjtNum>(pad.solimp[1], kMendedSolimp2);
}

void apply(const GripMend& mend, mjModel& m) {
  if (mend.elliptic) m.opt.cone = mjCONE_ELLIPTIC;
  if (mend.impratio) m.opt.impratio = kMendedImpratio;
  for (const int g : mend.pads) {
    mend_pad(mend, {m.geom_condim[g], m.geom_priority[g], m.geom_friction + 3 * g,
                    m.geom_solref + mjNREF * g, m.geom_solimp + mjNIMP * g});
  }
  for (const auto& [joint, value] : mend.armature) m.dof_armature[m.jnt_dofadr[joint]] = value;
  for (const auto& [joint, value] : mend.damping) m.dof_damping[m.jnt_dofadr[joint]] = value;
}

}  // namespace mjarm::detail
