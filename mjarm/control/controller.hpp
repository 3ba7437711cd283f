#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "mjarm/control/impedance.hpp"
#include "mjarm/control/reference.hpp"
#include "mjarm/control/robust_loop.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// How the arm is made to follow.
enum class ControlMode {
  servo,            ///< reference straight into the position actuators, as the tutorial does
  servo_gravity,    ///< the same with the torque of gravity fed forward
  feed_forward,     ///< the same with the whole torque of the reference fed forward
  computed_torque,  ///< model-based torque by inverting the actuators' gain and bias
  joint_impedance,  ///< springs and dampers between the joints and the reference
  tool_impedance,   ///< a spring and a damper between the tool and where the reference puts it
  robust,           ///< computed torque that copes with a wrong model (RobustLoop)
};
/// The names of the modes, in the order of ControlMode.
[[nodiscard]] std::span<const std::string_view> control_mode_names() noexcept;
/// As it is written above.
[[nodiscard]] std::string_view name(ControlMode mode) noexcept;
/// The mode of that name, or an error with the nearest one.
[[nodiscard]] Result<ControlMode> control_mode(std::string_view name);

/// Feedback of computed torque: e'' = -damping e' - stiffness e - integral (sum of e dt).
struct ControlOptions {
  double stiffness = 900;  ///< [1/s^2] acceleration per position error, > 0
  double damping = 60;     ///< [1/s]   acceleration per velocity error, > 0
  double integral = 0;     ///< [1/s^3] against loads the model does not know; 0 = none
  Impedance impedance = {};
  RobustOptions robust = {};
};

/// Turns the state and a reference into actuator commands; never writes forces past the actuators.
/// Keeps no memory of earlier steps but the integral, and what `robust` has learned. Owns its
/// scratch memory: one a thread.
class Controller {
 public:
  /// @return an error that names the joint whose actuator cannot be used this way.
  [[nodiscard]] static Result<Controller> create(const Model& model, const Arm& arm,
                                                 ControlMode mode,
                                                 const ControlOptions& options = {});
  ~Controller();
  Controller(Controller&&) noexcept;
  Controller& operator=(Controller&&) noexcept;

  [[nodiscard]] ControlMode mode() const noexcept;

  /// Writes the arm's rows of `ctrl` (nu,) for the step that comes, within their range; others stay
  /// as they are. Computed torque, feed-forward and the impedances land on `reference.next` where
  /// they stood on the reference before; computed torque closes an error like a spring and damper
  /// (ControlOptions) of unit mass, feed-forward by the gains of the servos. The plain servos only
  /// look at `reference.next`. The integral stands still while a limit cuts the command.
  /// @param qpos, qvel  full state of the model, (nq,) and (nv,).
  /// @return true where a ctrl or force limit cuts the command.
  bool command(std::span<const double> qpos, std::span<const double> qvel,
               const StepReference& reference, std::span<double> ctrl);

  /// Of the steps that come, in tool_impedance alone: along its z axis the tool is pushed, or goes
  /// on as told.
  /// @param offset  [m] along z, from where the reference puts the tool to where it shall be.
  void set_axial(std::optional<AxialPush> push, double offset);

  /// Forgets what the integral has gathered; `robust` keeps what it learned.
  void restart();

  /// Goes on with what another one of the same arm has learned, both in `robust`; else nothing.
  void learn_from(const Controller& other);
  /// (dof,) [N m or N] What the actuators were told last, within their limits; zeros at first.
  [[nodiscard]] const JointVec& torque() const noexcept;
  /// (dof,) [N m or N] Dry friction of the joints, as `robust` has learned it; else zeros.
  [[nodiscard]] JointVec friction() const;

 private:
  struct Impl;
  explicit Controller(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
