#include <algorithm>
#include <cmath>

#include "mjarm/control/actuation.hpp"
#include "mjarm/control/implicit_part.hpp"
#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/sim/holding_internal.hpp"
#include "mjarm/sim/raw_internal.hpp"

namespace mjarm {
namespace {

/// [kg or kg m^2] of a locked dof: a push of 1 kN moves it by 16 nm at a time step of 2 ms.
constexpr double kClamped = 1e6;

/// The kinds of geoms that a model tells apart have to fit into so many bits.
constexpr unsigned kKindBits = 16, kKinds = (1U << kKindBits) - 1;

/// One flag a body: it stands on a clamped base, with held joints between at most.
std::vector<char> clamped_bodies(const mjModel& m, std::span<const HeldJoint> joints) {
  std::vector<char> is_held(static_cast<std::size_t>(m.njnt), 0);
  for (const HeldJoint& joint : joints) is_held[m.dof_jntid[joint.dof]] = 1;
  std::vector<char> clamped(static_cast<std::size_t>(m.nbody), 0);
  for (int b = 1; b < m.nbody; ++b) {  // parents before children
    const int first = m.body_jntadr[b];
    bool all_held = true;
    for (int k = 0; k < m.body_jntnum[b]; ++k) all_held = all_held && is_held[first + k] != 0;
    const bool base = m.body_jntnum[b] == 1 && m.jnt_type[first] == mjJNT_FREE;
    clamped[b] = all_held && (base || clamped[m.body_parentid[b]] != 0) ? 1 : 0;
  }
  return clamped;
}

/// Lets clamped bodies and what stands no longer collide; all else does as before. Kinds of geoms
/// are given twice, in low and in high bits: what stands keeps the low ones, what is clamped the
/// high ones, what moves has both.
void part_from_ground(mjModel& m, const std::vector<char>& clamped) {
  const auto fits = [](const int* kinds, mjtSize count) {
    return std::all_of(kinds, kinds + count,
                       [](int kind) { return (static_cast<unsigned>(kind) & ~kKinds) == 0; });
  };
  if (!fits(m.geom_contype, m.ngeom) || !fits(m.geom_conaffinity, m.ngeom) || m.nflex > 0) return;
  const auto given = [&](int kind, int body) {
    const auto low = static_cast<unsigned>(kind), high = low << kKindBits;
    if (clamped[body] != 0) return static_cast<int>(high);
    return static_cast<int>(m.body_treeid[body] < 0 ? low : low | high);
  };
  std::fill_n(m.body_contype, m.nbody, 0);
  std::fill_n(m.body_conaffinity, m.nbody, 0);
  for (int g = 0; g < m.ngeom; ++g) {
    const int body = m.geom_bodyid[g];
    m.geom_contype[g] = given(m.geom_contype[g], body);
    m.geom_conaffinity[g] = given(m.geom_conaffinity[g], body);
    m.body_contype[body] |= m.geom_contype[g];
    m.body_conaffinity[body] |= m.geom_conaffinity[g];
  }
}

}  // namespace

Holding::Holding(const Model& model, const Arm& arm)
    : joints_(held_joints(model, arm)),
      implicit_mass_(Eigen::VectorXd::Zero(model.nv())),
      mass_(model.nv(), model.nv()),
      gap_(Eigen::VectorXd::Zero(model.nv())),
      moved_(joints_.size(), 0.0) {
  collect_dofs(*model.raw());
  const StepRule rule = step_rule(model);
  for (const ArmJoint& joint : arm.joints) add_mass(rule, joint.dof, joint.damping, joint.actuator);
  for (const HeldJoint& joint : joints_) {
    for (int k = 0; k < joint.dofs; ++k) {
      add_mass(rule, joint.dof + k, joint.damping, joint.actuator);
    }
  }
}

void Holding::collect_dofs(const mjModel& m) {
  std::vector<char> is_held(static_cast<std::size_t>(m.nv), 0);
  std::vector<char> in_tree(static_cast<std::size_t>(m.ntree), 0);
  for (const HeldJoint& joint : joints_) {
    for (int k = 0; k < joint.dofs; ++k) is_held[joint.dof + k] = 1;
    in_tree[m.dof_treeid[joint.dof]] = 1;
  }
  for (int i = 0; i < m.nv; ++i) {
    if (is_held[i] != 0) {
      held_.push_back(i);
    } else if (in_tree[m.dof_treeid[i]] != 0) {
      free_.push_back(i);
    }
  }
}

void Holding::clamp(mjModel& m) const {
  for (const HeldJoint& joint : joints_) {
    for (int k = 0; k < joint.dofs && !joint.actuator; ++k)
      m.dof_armature[joint.dof + k] += kClamped;
  }
  if (const std::vector<char> clamped = clamped_bodies(m, joints_);
      std::ranges::count(clamped, 1) > 0) {
    part_from_ground(m, clamped);
  }
  const raw::Data data(mj_makeData(&m));
  mj_setConst(&m, data.get());
}

void Holding::add_mass(const StepRule& rule, int dof, double damping,
                       const std::optional<ArmActuator>& actuator) {
  implicit_mass_[dof] = implicit_part(rule, dof, damping, actuator).mass;
}

void Holding::stand(std::span<const double> qpos) {
  place_.assign(qpos.begin(), qpos.end());
  std::ranges::fill(moved_, 0.0);
}

Eigen::VectorXd Holding::force(const mjModel& m, mjData& d, const Eigen::VectorXd& a_h) {
  using Vector = Eigen::Map<const Eigen::VectorXd>;
  const Vector bias(d.qfrc_bias, m.nv), passive(d.qfrc_passive, m.nv);
  mj_fwdActuation(&m, &d);
  mj_fullM(&m, &d, mass_.data());  // symmetric: order is no matter
  mass_.diagonal() += implicit_mass_;
  Eigen::VectorXd force = mass_(held_, held_) * a_h + bias(held_) - passive(held_);
  if (free_.empty()) return force;
  const Eigen::VectorXd own = Vector(d.qfrc_actuator, m.nv)(free_) + passive(free_) - bias(free_);
  const Eigen::MatrixXd across = mass_(held_, free_);
  return force + across * solve_symmetric(mass_(free_, free_), own - across.transpose() * a_h);
}

void Holding::hold(const mjModel& m, mjData& d) {
  // Both poles of e+ = e + h v+, v+ = v - h (Kp e + Kd v) are 1/2: a disturbance is gone after ten
  // steps, and a rounding is not answered with all the force there is.
  const double h = m.opt.timestep;
  const double stiffness = 0.25 / (h * h), damping = 0.75 / h;
  mj_differentiatePos(&m, gap_.data(), 1, d.qpos, place_.data());
  const Eigen::Map<const Eigen::VectorXd> v(d.qvel, m.nv);
  const Eigen::VectorXd torque =
      force(m, d, stiffness * gap_(held_) - damping * Eigen::VectorXd(v(held_)));
  Eigen::Index row = 0;
  for (const HeldJoint& joint : joints_) {
    if (joint.actuator) {
      const ArmActuator& actuator = *joint.actuator;
      const bool compensated = m.jnt_actgravcomp[m.dof_jntid[joint.dof]];
      const double own = torque[row] - (compensated ? d.qfrc_gravcomp[joint.dof] : 0.0);
      d.ctrl[actuator.id] =
          std::clamp(ctrl_for_torque(actuator, own, d.qpos[joint.qpos], d.qvel[joint.dof]),
                     actuator.ctrl_lower, actuator.ctrl_upper);
    } else {
      for (int k = 0; k < joint.dofs; ++k) {
        d.qfrc_applied[joint.dof + k] = torque[row + k] - d.qfrc_actuator[joint.dof + k];
      }
    }
    row += joint.dofs;
  }
}

void Holding::measure(const mjModel& m, const mjData& d) {
  mj_differentiatePos(&m, gap_.data(), 1, d.qpos, place_.data());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double off = gap_.segment(joints_[i].dof, joints_[i].dofs).cwiseAbs().maxCoeff();
    moved_[i] = std::max(moved_[i], off);
  }
}

}  // namespace mjarm
