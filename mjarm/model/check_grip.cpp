#include <algorithm>
#include <cmath>
#include <set>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/check_internal.hpp"
#include "mjarm/model/grip_diagnosis_internal.hpp"
#include "mjarm/model/grip_mend_internal.hpp"

namespace mjarm {
namespace {

using detail::GripDiagnosis;
using detail::GripFault;
using detail::GripOutcome;
using detail::GripSetting;

/// [m/s] creep that is told though nothing is known against it: 3 mm a minute.
constexpr double kMuchCreep = 5e-5;

/// With the first digits alone.
double rounded(double value, int digits) {
  if (!(value > 0) || std::isinf(value)) return value;
  const double last = std::pow(10, std::floor(std::log10(value)) - (digits - 1));
  return last * std::round(value / last);
}

std::string creep_text(const GripOutcome& outcome) {
  const bool holds = outcome.held && !outcome.lost;
  if (!holds) return text(msg::check_grip_falls);
  return text(msg::check_grip_rate, rounded(1e6 * outcome.creep, 2));
}

/// Turns what was measured into findings.
class GripFindings {
 public:
  GripFindings(const CheckContext& context, const GripDiagnosis& grip)
      : context_(context), m_(*context.model->raw()), grip_(grip) {}

  void add() {
    add_overlaps();
    const bool holds = grip_.mended.held && !grip_.mended.lost;
    if (!holds) {
      note(CheckCode::grip_not_measured, gripper_place(),
           text(msg::check_grip_not_measured,
                text(msg::check_grip_does_not_hold, 1000 * grip_.edge, detail::kTrialMass)));
      return;
    }
    add_creep();
    for (const GripFault& fault : grip_.faults) add_fault(fault);
  }

 private:
  void note(CheckCode code, Place place, std::string what) const {
    context_.add(code, Grade::note, std::move(place), std::move(what));
  }
  [[nodiscard]] Place gripper_place() const {
    return context_.description.actuator(context_.arm->gripper->drives.front().actuator);
  }
  [[nodiscard]] Place geom_place(int geom, const char* attribute) const {
    const char* const name = mj_id2name(&m_, mjOBJ_GEOM, geom);
    return context_.description.geom(name != nullptr ? name : "",
                                     object_name(&m_, mjOBJ_BODY, m_.geom_bodyid[geom]), attribute);
  }
  [[nodiscard]] std::string geom_words(int geom) const {
    const char* const name = mj_id2name(&m_, mjOBJ_GEOM, geom);
    return name != nullptr ? name : object_name(&m_, mjOBJ_BODY, m_.geom_bodyid[geom]);
  }
  [[nodiscard]] std::string costs(const GripFault& fault) const {
    return text(msg::check_grip_costs, creep_text(fault.left), creep_text(grip_.mended));
  }

  void add_overlaps() const {
    std::set<std::pair<int, int>> told;
    for (const detail::JawOverlap& one : grip_.overlaps) {
      if (!told.insert({one.geom[0], one.geom[1]}).second) continue;
      const double depth = 1000 * one.depth;
      note(CheckCode::jaws_overlap, geom_place(one.geom[0], "pos"),
           one.geom[1] < 0 ? text(msg::check_jaws_filled, depth)
                           : text(one.closing ? msg::check_jaws_meet : msg::check_jaws_overlap,
                                  geom_words(one.geom[1]), depth));
    }
  }

  void add_creep() const {
    const double edge = 1000 * grip_.edge;
    if (grip_.creeps) {
      note(CheckCode::grip_creep, gripper_place(),
           text(msg::check_grip_creep, edge, detail::kTrialMass, creep_text(grip_.as_is),
                creep_text(grip_.mended)));
    } else if (grip_.as_is.creep > kMuchCreep) {
      note(CheckCode::grip_creep, gripper_place(),
           text(msg::check_grip_creeps_anyway, edge, detail::kTrialMass, creep_text(grip_.as_is)));
    }
  }

  void add_fault(const GripFault& fault) const {
    switch (fault.setting) {
      case GripSetting::cone:
        return note(CheckCode::grip_cone, context_.description.option("cone"),
                    text(msg::check_grip_cone, costs(fault)));
      case GripSetting::impratio:
        return note(
            CheckCode::grip_impratio, context_.description.option("impratio"),
            text(msg::check_grip_impratio, m_.opt.impratio, detail::kMendedImpratio, costs(fault)));
      case GripSetting::soft:
      case GripSetting::slippery:
      case GripSetting::condim:
        return add_pads(fault);
      case GripSetting::damping:
        for (const auto& [joint, armature] : grip_.mend.armature) {
          if (armature > armature_of(joint)) add_damping(joint, armature, fault);
        }
        return;
      case GripSetting::slow:
        for (const auto& [joint, damping] : grip_.mend.damping) {
          add_slow(joint, msg::check_finger_slow, damping_of(joint), damping, fault);
        }
        for (const auto& [joint, armature] : grip_.mend.armature) {
          if (armature > armature_of(joint)) continue;
          add_slow(joint, msg::check_finger_heavy, armature_of(joint), armature, fault);
        }
    }
  }

  void add_pads(const GripFault& fault) const {
    std::vector<int> poor;
    for (const int g : grip_.mend.pads) {
      const detail::PadContact pad = detail::pad_contact(m_, g);
      const bool is_poor = fault.setting == GripSetting::soft       ? detail::is_soft(pad)
                           : fault.setting == GripSetting::slippery ? detail::is_slippery(pad)
                                                                    : detail::is_flat(pad);
      if (is_poor) poor.push_back(g);
    }
    if (poor.empty()) return;
    const int first = poor.front();
    const detail::PadContact pad = detail::pad_contact(m_, first);
    if (fault.setting == GripSetting::soft) {
      note(CheckCode::pads_soft, geom_place(first, "solref"),
           text(msg::check_pads_soft, poor.size(), pad.solref, pad.solimp, detail::kMendedSolref,
                detail::kMendedSolimp, costs(fault)));
    } else if (fault.setting == GripSetting::slippery) {
      note(CheckCode::pads_slippery, geom_place(first, "friction"),
           text(msg::check_pads_slippery, poor.size(), pad.friction, detail::kMendedFriction,
                costs(fault)));
    } else {
      note(CheckCode::pads_condim, geom_place(first, "condim"),
           text(msg::check_pads_condim, poor.size(), pad.condim));
    }
  }

  [[nodiscard]] double damping_of(int joint) const { return m_.dof_damping[m_.jnt_dofadr[joint]]; }
  [[nodiscard]] double armature_of(int joint) const {
    return m_.dof_armature[m_.jnt_dofadr[joint]];
  }
  [[nodiscard]] Place joint_place(int joint) const {
    return context_.description.joint(object_name(&m_, mjOBJ_JOINT, joint));
  }

  void add_damping(int joint, double armature, const GripFault& fault) const {
    note(CheckCode::finger_damping, joint_place(joint),
         text(msg::check_finger_damping,
              damping_of(joint) + detail::drive_damping(m_, *context_.arm->gripper, joint),
              m_.dof_M0[m_.jnt_dofadr[joint]], 1000 * m_.opt.timestep, rounded(armature, 3),
              costs(fault)));
  }

  void add_slow(int joint, Msg words, double is, double mended, const GripFault& fault) const {
    const double time = fault.left.touched ? fault.left.closing_time : kInf;
    note(CheckCode::finger_slow, joint_place(joint),
         text(words, is, time, rounded(mended, 3), grip_.mended.closing_time));
  }

  const CheckContext& context_;
  const mjModel& m_;
  const GripDiagnosis& grip_;
};

}  // namespace

void check_grip(const CheckContext& context) {
  if (!context.arm->gripper) return;
  const Result<GripDiagnosis> grip =
      detail::diagnose_grip(*context.model, *context.arm, context.load);
  if (!grip) {
    context.add(CheckCode::grip_not_measured, Grade::note,
                context.description.actuator(context.arm->gripper->drives.front().actuator),
                text(msg::check_grip_not_measured, grip.error().what));
    return;
  }
  GripFindings(context, *grip).add();
  context.grip_mend = grip->mend;
}

}  // namespace mjarm
