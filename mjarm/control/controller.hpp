#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "mjarm/control/reference.hpp"
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
/// The mode of that name, or an error with the nearest one.
[[nodiscard]] Result<ControlMode> control_mode(std::string_view name);

/// Feedback of computed torque. At time step h the loop is stable for
/// 2 h damping + h^2 stiffness < 4.
struct ControlOptions {
  double stiffness = 900;  ///< [1/s^2] acceleration per position error, > 0
  double damping = 60;     ///< [1/s]   acceleration per velocity error, > 0
};

/// Turns the state and a reference into actuator commands; never writes forces past the actuators.
/// Keeps no memory of earlier steps. Owns its scratch memory: one a thread.
class Controller {
 public:
  /// @return an error that names the joint whose actuator cannot be used this way.
  [[nodiscard]] static Result<Controller> make(const Model& model, const Arm& arm, ControlMode mode,
                                               const ControlOptions& options = {});
  ~Controller();
  Controller(Controller&&) noexcept;
  Controller& operator=(Controller&&) noexcept;

  [[nodiscard]] ControlMode mode() const noexcept;

  /// Writes the arm's rows of `ctrl` (nu,) for the step that comes, within their range; others stay
  /// as they are. Computed torque lands on `reference.next` where it stood on the reference before,
  /// and closes an error like a spring and damper (ControlOptions) of unit mass. The servos only
  /// look at `reference.next`.
  /// @param qpos, qvel  full state of the model, (nq,) and (nv,).
  /// @return true where a ctrl or force limit cuts the command.
  bool command(std::span<const double> qpos, std::span<const double> qvel,
               const StepReference& reference, std::span<double> ctrl);

 private:
  struct Impl;
  explicit Controller(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
