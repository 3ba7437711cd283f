#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// One touching pair at one time.
struct Contact {
  std::string first;   ///< geom name, or body name where the geom has none
  std::string second;
  double depth = 0;    ///< [m] > 0 where they overlap
};

/// A copy of the full state, for drawing and for going back; holds no MuJoCo types.
struct Snapshot {
  double time = 0;            ///< [s]
  std::vector<double> state;  ///< MuJoCo's integration state, in its own order
};

/// One simulated world. Every read after a write is up to date: positions, contacts and sensors are
/// recomputed before anybody can see them.
class Sim {
 public:
  explicit Sim(const Model& model);
  ~Sim();
  Sim(Sim&&) noexcept;
  Sim& operator=(Sim&&) noexcept;

  /// Back to keyframe `name`, or to the initial state where `name` is empty.
  [[nodiscard]] Result<void> reset(std::string_view keyframe = {});
  /// Puts the arm's joints at `q` (dof,), at rest, with matching ctrl where its actuators are servos.
  void place(const Arm& arm, std::span<const double> q);
  /// One time step with these actuator commands (nu,).
  /// @return an error when the simulation became unstable (NaN, huge values).
  [[nodiscard]] Result<void> step(std::span<const double> ctrl);

  [[nodiscard]] const Model& model() const noexcept;
  [[nodiscard]] double time() const noexcept;                     ///< [s]
  [[nodiscard]] std::span<const double> qpos() const noexcept;    ///< (nq,)
  [[nodiscard]] std::span<const double> qvel() const noexcept;    ///< (nv,)
  [[nodiscard]] std::span<const double> ctrl() const noexcept;    ///< (nu,) of the last step
  [[nodiscard]] std::span<const double> actuator_force() const noexcept;  ///< (nu,) [N m or N]
  [[nodiscard]] std::span<const double> sensor_data() const noexcept;     ///< as MuJoCo orders it
  [[nodiscard]] JointState arm_state(const Arm& arm) const;       ///< q, v, a of the arm's joints
  [[nodiscard]] Pose tool(const Arm& arm) const;                  ///< X_WT as simulated
  [[nodiscard]] std::vector<Contact> contacts() const;
  [[nodiscard]] Snapshot snapshot() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
