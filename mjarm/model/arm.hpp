#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"

namespace mjarm {

/// Whether a joint turns about its axis or moves along it.
enum class JointType { hinge, slide };

/// An actuator that drives one joint directly: force = gain * ctrl + bias[0] + bias[1] * length +
/// bias[2] * velocity, clamped to the force range; joint torque = gear * force, length = gear * q.
struct ArmActuator {
  std::string name;
  int id = -1;             ///< row of ctrl that drives it
  double gear = 1;         ///< transmission ratio, != 0
  double gain = 0;         ///< [N m or N per unit ctrl], != 0
  double bias[3] = {0};    ///< [N m], [N m/rad], [N m s/rad]
  double ctrl_lower = 0;   ///< lowest ctrl, -inf where not limited
  double ctrl_upper = 0;   ///< highest ctrl, inf where not limited
  double force_lower = 0;  ///< [N m or N] lowest force, -inf where not limited
  double force_upper = 0;  ///< [N m or N] highest force, inf where not limited
};

/// One moving joint of an arm. The joint's frame J moves by the joint value q: X_PJ(q) = X_PJ *
/// motion(axis, q), where P is the moved frame of the joint before (the world for the first joint).
struct ArmJoint {
  std::string name;
  JointType type = JointType::hinge;
  Pose X_PJ;                                        ///< frame J in frame P at q = 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, in J
  double damping = 0;                               ///< [N m s/rad or N s/m] viscous, >= 0
  double armature = 0;                              ///< [kg m^2 or kg] rotor inertia, >= 0
  int qpos = -1;                                    ///< index in the model's qpos
  int dof = -1;                                     ///< index in the model's qvel
  std::optional<ArmActuator> actuator;              ///< none where nothing drives the joint
};

/// Where a limit comes from.
enum class LimitSource {
  file,      ///< the model file itself
  table,     ///< the public figures of a known robot (UR5e, Panda), recognised by its geometry
  standard,  ///< a stated value of mjarm, where nothing better is known
};

/// "file", "table" or "default".
[[nodiscard]] std::string_view name(LimitSource source) noexcept;

/// Where each limit of one joint comes from. Positions are always the file's.
struct LimitSources {
  LimitSource velocity = LimitSource::standard;
  LimitSource acceleration = LimitSource::standard;
  LimitSource jerk = LimitSource::standard;
  LimitSource torque = LimitSource::standard;
};

/// What the joints may do, one entry a joint; every entry is finite and positive except `lower` and
/// `upper`, which are -inf and inf for a joint without stops.
struct JointLimits {
  JointVec lower;                             ///< [rad or m]
  JointVec upper;                             ///< [rad or m]
  JointVec velocity;                          ///< [rad/s or m/s]
  JointVec acceleration;                      ///< [rad/s^2 or m/s^2]
  JointVec jerk;                              ///< [rad/s^3 or m/s^3]
  JointVec torque;                            ///< [N m or N]
  std::array<LimitSources, kMaxDof> sources;  ///< the first dof entries are meant
};

/// An actuator that opens and closes a gripper, or one finger of it.
struct GripperDrive {
  std::string actuator;    ///< its name
  int id = -1;             ///< row of ctrl that drives it
  double ctrl_open = 0;    ///< ctrl that opens
  double ctrl_closed = 0;  ///< ctrl that closes
};

/// The gripper at the end of an arm.
struct Gripper {
  std::vector<GripperDrive> drives;  ///< one, or one a finger, which open and close together
  std::vector<std::string> joints;   ///< names of the joints they move
};

/// A geom of a model and its body, by their numbers.
struct ModelGeom {
  int geom = -1;
  int body = -1;
};

/// Two parts of a model that overlap in every posture: neighbours whose shapes reach into each
/// other, a link that turns in its foot or in the floor. Whoever wrote the file meant it so.
struct DesignOverlap {
  int link = -1;                          ///< number of a body that the arm moves
  int other = -1;                         ///< of another such body, or of a geom that stands
  bool stands = false;                    ///< `other` is a geom
  std::array<std::string, 2> names = {};  ///< of both; of its body where a geom has none

  /// Whether it is between these two.
  [[nodiscard]] bool is_of(ModelGeom a, ModelGeom b) const {
    const auto is_other = [this](ModelGeom one) { return other == (stands ? one.geom : one.body); };
    return (a.body == link && is_other(b)) || (b.body == link && is_other(a));
  }
};

/// The arm in a model: joints from base to tip and the fixed tool frame T. A plain value; needs no
/// MuJoCo. Poses are in the world frame W of the loaded file (for a URDF: its root link).
struct Arm {
  std::string name;              ///< model name of the file
  std::vector<ArmJoint> joints;  ///< base to tip, 1 to kMaxDof
  JointLimits limits;
  std::string tip;  ///< name of the tool frame (site or body)
  Pose X_JT;        ///< tool frame in the frame of the last joint
  JointVec home;    ///< [rad or m] of home_keyframe(), the middle of the limits where there is none
  std::optional<Gripper> gripper;
  /// What overlaps (or touches) by design, which is no contact to planning, checks and runs. A
  /// simulation pushes such parts apart all the same, as the file has it.
  std::vector<DesignOverlap> overlapping = {};

  [[nodiscard]] int dof() const { return static_cast<int>(joints.size()); }
  [[nodiscard]] bool overlap_by_design(ModelGeom a, ModelGeom b) const {
    return std::any_of(overlapping.begin(), overlapping.end(),
                       [&](const DesignOverlap& pair) { return pair.is_of(a, b); });
  }
};

/// The positions of an arm's joints, (dof,) [rad or m].
/// @param qpos  (nq,) of its model
[[nodiscard]] inline JointVec arm_positions(const Arm& arm, std::span<const double> qpos) {
  JointVec q(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    q[i] = qpos[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)];
  }
  return q;
}

}  // namespace mjarm
