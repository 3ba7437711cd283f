#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// How the arm is made to follow.
enum class ControlMode {
  servo,            ///< reference straight into the position actuators, as the tutorial does
  servo_gravity,    ///< the same with the torque of gravity fed forward
  computed_torque,  ///< model-based torque by inverting the actuators' gain and bias
};
/// "servo", "servo_gravity", "computed_torque".
[[nodiscard]] std::string_view name(ControlMode mode) noexcept;

struct ControlOptions {
  double stiffness = 900;  ///< [1/s^2] error feedback of computed torque, > 0
  double damping = 60;     ///< [1/s]   rate feedback of computed torque, >= 0
};

/// Turns the state and a reference into actuator commands; never writes forces past the actuators.
/// Owns its scratch memory: one a thread.
class Controller {
 public:
  /// @return an error that names the joint whose actuator cannot be used this way.
  [[nodiscard]] static Result<Controller> make(const Model& model, const Arm& arm, ControlMode mode,
                                               const ControlOptions& options = {});
  ~Controller();
  Controller(Controller&&) noexcept;
  Controller& operator=(Controller&&) noexcept;

  /// Writes the arm's rows of `ctrl` (nu,), others stay as they are.
  /// @param qpos, qvel  full state of the model, (nq,) and (nv,).
  /// @param reference   of the arm's joints, at the end of the step that follows.
  /// @return true where a ctrl or force limit cut the command.
  bool command(std::span<const double> qpos, std::span<const double> qvel,
               const JointState& reference, std::span<double> ctrl);

 private:
  struct Impl;
  explicit Controller(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
