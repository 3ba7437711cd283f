#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/model/grip_diagnosis_internal.hpp"
#include "mjarm/model/grip_mend_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kMaxDofs = 120;           // beyond them a trial takes seconds of computing time
constexpr double kSmallestCube = 2e-3;  // [m]
constexpr double kHolds = 2e-6;         // [m/s] 0.1 mm a minute: nothing to mend
constexpr double kMatters = 1.3;        // times as much creep
constexpr double kSlowClosing = 1;      // [s] for half of the opening
constexpr double kSwift = 0.5;          // [s] what it is mended to
constexpr double kHeavyDamping = 0.5;   // of the inertia that a joint's damping takes in a step
constexpr double kLightDamping = 0.05;
constexpr double kHeavyDrive = 3;   // the same of the drive's damping, which is part of a servo
constexpr double kHeavyRotor = 10;  // times the inertia of what a joint moves

/// [m/s] above all others where it is not held.
double creep_of(const GripOutcome& outcome) {
  return outcome.held && !outcome.lost ? outcome.creep : kInf;
}

bool matters(double more, double less) {
  return std::isinf(more) ? !std::isinf(less) : more > kMatters * less && more > kHolds;
}

bool are_alike(const mjModel& m, int g, int other) {
  return m.geom_bodyid[g] == m.geom_bodyid[other] && m.geom_condim[g] == m.geom_condim[other] &&
         m.geom_priority[g] == m.geom_priority[other] &&
         std::equal(m.geom_solref + mjNREF * g, m.geom_solref + mjNREF * (g + 1),
                    m.geom_solref + mjNREF * other) &&
         std::equal(m.geom_solimp + mjNIMP * g, m.geom_solimp + mjNIMP * (g + 1),
                    m.geom_solimp + mjNIMP * other);
}

class Diagnosis {
 public:
  Diagnosis(const mjModel& m, const Gripper& gripper, const GripTrial& trial)
      : m_(m), gripper_(gripper), trial_(trial) {}

  GripDiagnosis run() {
    out_.overlaps = trial_.overlaps();
    out_.as_is = trial_.run({});
    out_.overlaps.insert(out_.overlaps.end(), out_.as_is.overlaps.begin(),
                         out_.as_is.overlaps.end());
    for (const JawOverlap& one : out_.overlaps) part(one);
    out_.mend.pads = out_.as_is.held ? with_their_like(out_.as_is.pads) : trial_.finger_geoms();
    find_candidates();
    out_.mended = trial_.run(out_.mend);
    add_pads();
    keep_what_matters();
    if (matters(creep_of(out_.mended), creep_of(out_.as_is))) drop_all();
    if (out_.mend.empty()) out_.mended = out_.as_is;
    out_.creeps = matters(creep_of(out_.as_is), creep_of(out_.mended));
    return std::move(out_);
  }

 private:
  /// Leaves contacts as they are: mended they hold less.
  void drop_all() {
    const std::vector<std::pair<int, int>> exclude = out_.mend.exclude;
    out_.mend = {.exclude = exclude};
    out_.mended = exclude.empty() ? out_.as_is : trial_.run(out_.mend);
    out_.faults.clear();
  }

  /// Has the bodies of two parts that overlap collide no more.
  void part(const JawOverlap& one) {
    if (one.geom[1] < 0) return;
    const std::pair<int, int> bodies =
        std::minmax(m_.geom_bodyid[one.geom[0]], m_.geom_bodyid[one.geom[1]]);
    const bool named = mj_id2name(&m_, mjOBJ_BODY, bodies.first) != nullptr &&
                       mj_id2name(&m_, mjOBJ_BODY, bodies.second) != nullptr;
    std::vector<std::pair<int, int>>& all = out_.mend.exclude;
    if (named && std::ranges::find(all, bodies) == all.end()) all.push_back(bodies);
  }

  /// With what is of the same body and touches things in the same way.
  [[nodiscard]] std::vector<int> with_their_like(const std::vector<int>& geoms) const {
    std::vector<int> out;
    for (int g = 0; g < static_cast<int>(m_.ngeom); ++g) {
      const bool collides = m_.geom_contype[g] != 0 || m_.geom_conaffinity[g] != 0;
      const auto alike = [&](int other) { return g == other || are_alike(m_, g, other); };
      if (collides && std::ranges::any_of(geoms, alike)) out.push_back(g);
    }
    return out;
  }

  /// Once mended, other parts of the fingers may touch.
  void add_pads() {
    std::vector<int> pads = out_.mended.pads;
    if (out_.as_is.held) pads.insert(pads.end(), out_.mend.pads.begin(), out_.mend.pads.end());
    pads = with_their_like(pads);
    if (!out_.mended.held || pads == out_.mend.pads) return;
    out_.mend.pads = std::move(pads);
    find_candidates();
    out_.mended = trial_.run(out_.mend);
  }

  /// What is less than usual for a firm hold.
  void find_candidates() {
    GripMend& mend = out_.mend;
    mend.elliptic = m_.opt.cone != mjCONE_ELLIPTIC;
    mend.impratio = m_.opt.impratio < kMendedImpratio;
    const auto any = [&](const auto& is_poor) { return std::ranges::any_of(mend.pads, is_poor); };
    mend.stiff = any([&](int g) { return is_soft(pad_contact(m_, g)); });
    mend.friction = any([&](int g) { return is_slippery(pad_contact(m_, g)); });
    mend.condim = any([&](int g) { return is_flat(pad_contact(m_, g)); });
    mend.armature.clear();
    mend.damping.clear();
    for (const int j : trial_.hand_joints()) mend_joint(j);
  }

  void mend_joint(int j) {
    const int v = m_.jnt_dofadr[j];
    const GripOutcome& as_is = out_.as_is;
    const double armature = m_.dof_armature[v], own = std::max(m_.dof_M0[v] - armature, 1e-9);
    const double dt = m_.opt.timestep, time = as_is.closing_time;
    const bool slow = as_is.touched && (time > kSlowClosing || !as_is.held);
    double damping = m_.dof_damping[v];
    if (slow && time > kSlowClosing && damping > 0) {
      damping *= kSwift / time;
      out_.mend.damping.emplace_back(j, damping);
    }
    const double drive = drive_damping(m_, gripper_, j);
    if (damping * dt > kHeavyDamping * m_.dof_M0[v]) {
      out_.mend.armature.emplace_back(j, damping * dt / kLightDamping - own);
    } else if (drive * dt > kHeavyDrive * m_.dof_M0[v]) {
      out_.mend.armature.emplace_back(j, drive * dt - own);
    } else if (slow && armature > kHeavyRotor * own) {
      out_.mend.armature.emplace_back(j, armature * std::pow(kSwift / (2 * time), 2));
    }
  }

  /// The joints of `armature` whose inertia grows, or those whose inertia does not.
  void drop_armature(GripMend& mend, bool grows) const {
    std::erase_if(mend.armature, [&](const std::pair<int, double>& one) {
      return (one.second > m_.dof_armature[m_.jnt_dofadr[one.first]]) == grows;
    });
  }

  [[nodiscard]] GripMend without(const GripMend& mend, GripSetting setting) const {
    GripMend out = mend;
    switch (setting) {
      case GripSetting::cone:
        out.elliptic = false;
        break;
      case GripSetting::impratio:
        out.impratio = false;
        break;
      case GripSetting::soft:
        out.stiff = false;
        break;
      case GripSetting::slippery:
        out.friction = false;
        break;
      case GripSetting::condim:
        out.condim = false;
        break;
      case GripSetting::damping:
        drop_armature(out, true);
        break;
      case GripSetting::slow:
        out.damping.clear();
        drop_armature(out, false);
        break;
    }
    return out;
  }

  /// Leaves out what costs nothing, and notes what the rest costs.
  void keep_what_matters() {
    const bool firm = creep_of(out_.as_is) <= kHolds;
    for (int k = 0; k < kGripSettings; ++k) {
      const auto setting = static_cast<GripSetting>(k);
      const GripMend trial = without(out_.mend, setting);
      if (trial == out_.mend) continue;
      const GripOutcome left = trial_.run(trial);
      bool costs = !firm && matters(creep_of(left), creep_of(out_.mended));
      // MuJoCo asks for elliptic cones wherever impratio is above 1.
      if (setting == GripSetting::cone)
        costs = !firm && !matters(creep_of(out_.mended), creep_of(left));
      // A cube with flat sides needs neither torsion nor rolling, and little friction; others do.
      if (setting == GripSetting::condim || setting == GripSetting::slippery) {
        costs = !matters(creep_of(out_.mended), creep_of(left));
      }
      if (setting == GripSetting::slow) {
        costs = (left.closing_time > kSlowClosing || !left.held) && out_.mended.held &&
                out_.mended.closing_time < kSlowClosing;
      }
      if (costs) {
        out_.faults.push_back({setting, left});
      } else {
        out_.mend = trial;
        out_.mended = left;
      }
    }
  }

  const mjModel& m_;
  const Gripper& gripper_;
  const GripTrial& trial_;
  GripDiagnosis out_;
};

}  // namespace

PadContact pad_contact(const mjModel& m, int geom) {
  PadContact pad{m.geom_solref[mjNREF * geom], m.geom_solimp[mjNIMP * geom],
                 m.geom_friction[3 * geom], m.geom_condim[geom]};
  if (m.geom_priority[geom] > 0) return pad;
  const double weight = m.geom_solmix[geom] / (m.geom_solmix[geom] + 1);
  if (pad.solref > 0) pad.solref = weight * pad.solref + (1 - weight) * 0.02;
  pad.solimp = weight * pad.solimp + (1 - weight) * 0.9;
  pad.friction = std::max(pad.friction, 1.0);
  return pad;
}

double drive_damping(const mjModel& m, const Gripper& gripper, int joint) {
  double sum = 0;
  for (int a = 0; a < static_cast<int>(m.nactuator); ++a) {
    const double gear = m.actuator_gear[6 * m.actuator_outadr[a]];
    const double damping = -m.actuator_biasprm[mjNBIAS * a + 2] * gear * gear;
    const bool drives =
        std::ranges::count(gripper.drives, m.actuator_ctrladr[a], &GripperDrive::id) > 0;
    if (!drives || !(damping > 0)) continue;
    const int target = m.actuator_trnid[2 * a];
    if (m.actuator_trntype[a] == mjTRN_JOINT && target == joint) sum += damping;
    if (m.actuator_trntype[a] != mjTRN_TENDON) continue;
    for (int w = m.tendon_adr[target]; w < m.tendon_adr[target] + m.tendon_num[target]; ++w) {
      const bool on_joint = m.wrap_type[w] == mjWRAP_JOINT && m.wrap_objid[w] == joint;
      if (on_joint) sum += damping * m.wrap_prm[w] * m.wrap_prm[w];
    }
  }
  return sum;
}

bool is_soft(const PadContact& pad) {
  return pad.solref > 0 && (pad.solref > kSlowestSolref || pad.solimp < kLeastSolimp);
}
bool is_slippery(const PadContact& pad) { return pad.friction < kLeastFriction; }
bool is_flat(const PadContact& pad) { return pad.condim < kLeastCondim; }

Result<GripDiagnosis> diagnose_grip(const Model& model, const Arm& arm,
                                    const LoadOptions& options) {
  if (model.nv() > kMaxDofs) {
    return fail(Errc::not_available, text(msg::check_grip_too_large, model.nv()));
  }
  const Result<Jaws> jaws = find_jaws(model, arm);
  if (!jaws) return fail(jaws.error());
  const double edge = trial_edge(*jaws);
  if (edge < kSmallestCube) return fail(Errc::not_available, text(msg::check_grip_does_not_open));
  const Result<MjModelPtr> m = with_trial_cube(model, edge, options);
  if (!m) return fail(m.error());
  const GripTrial trial(**m, model, arm, *jaws);
  if (!trial.opens()) return fail(Errc::not_available, text(msg::check_grip_does_not_open));
  GripDiagnosis out = Diagnosis(**m, *arm.gripper, trial).run();
  out.edge = edge;
  return out;
}

}  // namespace mjarm::detail
