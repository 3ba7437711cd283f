#pragma once

#include <optional>
#include <span>

#include "mjarm/control/reference.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Springs and dampers of the impedance modes.
struct Impedance {
  double joint_stiffness = 200;     ///< [N m/rad or N/m] of each joint, > 0
  double tool_stiffness = 1000;     ///< [N/m] of the tool, > 0
  double tool_turn_stiffness = 50;  ///< [N m/rad] of the tool, > 0
  /// [N m/rad or N/m] >= 0, of joints to spare: pulls the arm to the reference without moving the
  /// tool.
  double posture_stiffness = 20;
  double damping_ratio = 1;  ///< of all springs, >= 0; 1 = critical
};

/// How the tool behaves along its own z axis in the place of its spring: as if pushed by `force`
/// and braked against the world.
struct AxialPush {
  double force = 0;    ///< [N] along z
  double damping = 0;  ///< [N s/m] >= 0, against any speed along z
  /// [N] What pushes the tool from outside across its z axis, in the world, as far as it is known:
  /// friction. What it and the spring have left over would move a bent arm along z as well.
  Eigen::Vector3d across_W = Eigen::Vector3d::Zero();
};

/// Where the arm is and shall be, all shape (dof,).
struct ImpedanceState {
  JointVec q, v;                       ///< [rad or m], [rad/s or m/s]
  JointVec q_ref, v_ref;               ///< likewise
  std::optional<AxialPush> push = {};  ///< of the tool, in place of its spring along z
  double axial_offset = 0;  ///< [m] along z, from where q_ref puts the tool to where it shall be
  /// (dof,) [kg m^2 or kg] what the integrator adds to the diagonal of the mass matrix; for a push.
  JointVec implicit_mass = {};
};

/// Torque of a spring and a damper at each joint, (dof,) [N m or N]. Each damper is made for the
/// inertia of its joint alone, the diagonal of the mass matrix.
/// @param mass  (dof, dof) [kg m^2], the arm's part of the mass matrix at q.
[[nodiscard]] JointVec joint_spring(const Impedance& impedance, const ImpedanceState& state,
                                    const Eigen::MatrixXd& mass);

/// Joint torque (dof,) of a spring and a damper between the tool at `q` and where `q_ref` puts it
/// (O. Khatib, IEEE J. Robotics and Automation 3 (1987) 43). The damping matrix is made by double
/// diagonalisation of the stiffness and the inertia that the tool feels (A. Albu-Schaeffer et al.,
/// IEEE/RSJ IROS 2003); near singularities, where that inertia has no bound, it is kept finite.
/// Joints to spare are held by posture_stiffness through the null space of the transposed
/// Jacobian's dynamically consistent inverse. A push leaves the tool free along its z axis, with
/// its own force and damper there (M. Raibert, J. Craig, ASME J. Dynamic Systems 103 (1981) 126).
[[nodiscard]] JointVec tool_spring(const Impedance& impedance, const ImpedanceState& state,
                                   const Eigen::MatrixXd& mass, const LinkChain& links);

}  // namespace mjarm
