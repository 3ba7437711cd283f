#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/held_joints.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// One touching pair at one time.
struct Contact {
  std::string first;  ///< geom name, or body name where the geom has none
  std::string second;
  double depth = 0;  ///< [m] > 0 where they overlap, of the deepest point
  int body1 = -1;    ///< the body of `first` in the model; -1 where it is no geom
  int body2 = -1;    ///< that of `second`
  int geom1 = -1;    ///< `first` itself in the model; -1 where it is no geom
  int geom2 = -1;    ///< `second`
};

/// Whether it is between parts that overlap in every posture: Arm::overlapping.
[[nodiscard]] bool is_by_design(const Arm& arm, const Contact& contact);

/// A copy of the full state, for drawing and for going back; holds no MuJoCo types.
struct Snapshot {
  double time = 0;                 ///< [s]
  std::vector<double> state;       ///< MuJoCo's integration state, in its own order
  std::vector<double> place = {};  ///< (nq,) where joints are held; empty where none are
};

/// A joint that is kept where it stands, and how well that went.
struct HeldState {
  HeldJoint joint;
  double moved = 0;  ///< [rad or m] farthest from its place since the world was put somewhere
};

/// One simulated world. Every read after a write is up to date: positions, velocities, contacts and
/// their sensors are recomputed before anybody can see them. Forces and accelerations are those of
/// the step just done; after `reset`, `place`, `set_state` and `restore` those that the state and
/// the ctrl as they stand would give. Reading never changes what comes next.
class Sim {
 public:
  /// Stands in the initial state of the model (not in a keyframe).
  explicit Sim(const Model& model);
  ~Sim();
  Sim(Sim&&) noexcept;
  Sim& operator=(Sim&&) noexcept;

  /// Back to keyframe `name`, or to the initial state where `name` is empty.
  /// @return an error with the nearest name.
  [[nodiscard]] Result<void> reset(std::string_view keyframe = {});
  /// Back to home_keyframe() where there is one, else to the initial state: as plans take a scene.
  void reset_home();
  /// Puts the arm's joints at `q` (dof,), at rest, with matching ctrl where its actuators are
  /// servos. All else stays.
  void place(const Arm& arm, std::span<const double> q);
  /// Puts a body that has a free joint, at rest. All else stays; a body without one does too.
  void place_free(std::string_view body, const Pose& X_WB);
  /// Puts the whole model at `qpos` (nq,), `qvel` (nv,). All else stays.
  void set_state(std::span<const double> qpos, std::span<const double> qvel);
  /// Back to a snapshot of the same model; what follows is the same to the last bit.
  /// @return an error where the snapshot is of another model.
  [[nodiscard]] Result<void> restore(const Snapshot& snapshot);
  /// Sets one actuator command, for the followers to hold while they move the arm (a gripper).
  void set_ctrl(int actuator, double value);
  /// Pushes `body` (its number in the model) at its centre of mass in every step that comes, until
  /// it is set anew; zeros end it. Part of snapshots, and gone after a reset.
  /// @param force_W   [N] in the world frame.
  /// @param torque_W  [N m] in the world frame.
  void set_external_force(int body, const Eigen::Vector3d& force_W,
                          const Eigen::Vector3d& torque_W);
  /// Ends all pushes.
  void clear_external_forces();
  /// Keeps the joints that are not of `arm` (held_joints()) where they stand, in every step that
  /// comes: by their own actuators with gravity and the arm's motion compensated, whatever their
  /// ctrl is told otherwise; locked where they have none. Where the world is put somewhere they
  /// stay there from then on.
  void hold_others(const Arm& arm);
  /// The joints that are held, in the order of the model.
  [[nodiscard]] std::vector<HeldState> held() const;
  /// Goes on with other masses in the next step: something was hung on the robot, or taken off.
  /// @param model  the same one with other masses (with_payload()).
  void take_masses(const Model& model);
  /// One time step with these actuator commands (nu,).
  /// @return an error that names time and joint when the simulation became unstable (NaN, huge
  ///         values); the world is then back in its initial state. A ctrl that is not a number is
  ///         an error as well, and changes nothing.
  [[nodiscard]] Result<void> step(std::span<const double> ctrl);

  [[nodiscard]] const Model& model() const noexcept;
  [[nodiscard]] double time() const noexcept;                   ///< [s]
  [[nodiscard]] std::span<const double> qpos() const noexcept;  ///< (nq,)
  [[nodiscard]] std::span<const double> qvel() const noexcept;  ///< (nv,)
  [[nodiscard]] std::span<const double> ctrl() const noexcept;  ///< (nu,) of the last step
  [[nodiscard]] std::span<const double> actuator_force() const noexcept;  ///< [N m or N], no gear
  [[nodiscard]] std::span<const double> sensor_data() const noexcept;     ///< as MuJoCo orders it
  [[nodiscard]] JointState arm_state(const Arm& arm) const;  ///< q, v, a of the arm's joints
  [[nodiscard]] JointVec arm_torque(const Arm& arm) const;   ///< (dof,) [N m or N] of its drives
  [[nodiscard]] Pose tool(const Arm& arm) const;             ///< X_WT as simulated
  [[nodiscard]] Pose body_pose(int body) const;              ///< X_WB of a body, by its number
  [[nodiscard]] std::vector<Contact> contacts() const;
  /// Contacts of what the arm moves (links, gripper), with the world or with itself, but for what
  /// overlaps by design.
  [[nodiscard]] std::vector<Contact> contacts(const Arm& arm) const;
  [[nodiscard]] Snapshot snapshot() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
