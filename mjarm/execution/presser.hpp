#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/motion_clock.hpp"
#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/model/force_sensor.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// Where a tool that presses was at one step, and how hard it pressed.
struct InkPoint {
  std::size_t move = 0;  ///< index in the plan
  double time = 0;       ///< [s] of the simulation
  Pose X_WT;             ///< of the tool
  double off = 0;        ///< [m] across its z axis from where the plan has it at that moment
  double force = 0;      ///< [N] along its z axis, by the force sensor
};

/// What became of a motion on which the tool was to press.
struct PressedStroke {
  std::size_t move = 0;  ///< index in the plan
  bool touched = false;  ///< it met something within its reach
  double landing = 0;    ///< [N] largest force until the stroke began
  double least = 0;      ///< [N] along z while the tool was on its way
  double most = 0;       ///< [N]
  double depth = 0;      ///< [m] along z from the planned motion to where it met something
};

/// Presses a tool on things with a force that its sensor measures, on those motions of a plan, its
/// strokes, that say so (PlannedMove::press). At the beginning of each the plan waits while the
/// tool is weighed, goes along its z axis until it meets something, and the force settles; at its
/// end, while the tool is lifted. Where the thing is, and how it is tilted, the plan need not know.
/// On the stroke the tool is free along z and pushed with the force, to which the integral of what
/// it lacks is added, so that neither friction nor a load that the model does not know stays in it.
class Presser {
 public:
  /// Of the tool across its z axis: friction of some tenths of a newton moves it by less than 0.1
  /// mm.
  static constexpr Impedance kImpedance{.tool_stiffness = 5000, .tool_turn_stiffness = 200};

  /// @return none where no motion presses; an error where the arm has no force sensor or the
  ///         control is not tool_impedance.
  [[nodiscard]] static Result<std::optional<Presser>> create(const Model& model,
                                                             const MotionPlan& plan,
                                                             ControlMode control);

  /// Before each step but the first: tells the controller how to behave along z.
  /// @return true where the plan has to wait.
  [[nodiscard]] bool look(const Sim& sim, Controller& controller, const MotionClock& clock);

  /// The tool is on its way down, presses, or on its way up.
  [[nodiscard]] bool is_down() const { return phase_ != Phase::above; }
  [[nodiscard]] bool writes() const { return phase_ == Phase::write; }
  /// One point a step on strokes, in order of time.
  [[nodiscard]] const std::vector<InkPoint>& ink() const { return ink_; }
  [[nodiscard]] const std::vector<PressedStroke>& strokes() const { return strokes_; }
  /// Forgets all of it.
  void restart();

 private:
  enum class Phase { above, weigh, seek, settle, write, lift };

  Presser(const Model& model, const MotionPlan& plan, ForceSensor sensor);
  [[nodiscard]] Eigen::Vector3d force(const Sim& sim) const;
  void enter(Phase phase);
  void begin_lift(double depth);
  [[nodiscard]] bool begins_stroke(const MotionClock& clock) const;
  void weigh(const Sim& sim, const MotionClock& clock, double depth);
  [[nodiscard]] AxialPush seek(const Pose& X_WT, double depth) const;
  [[nodiscard]] AxialPush push(const Pose& X_WT, double wanted, const Eigen::Vector3d& measured,
                               double damping);

  const MotionPlan* plan_;
  ForceSensor sensor_;
  LinkChain links_;
  double timestep_;
  Phase phase_ = Phase::above;
  int steps_ = 0;                                     ///< in this phase
  std::size_t move_ = 0;                              ///< the stroke
  std::optional<std::size_t> last_move_;              ///< the stroke before
  Eigen::Vector3d weight_ = Eigen::Vector3d::Zero();  ///< [N] of what hangs on the sensor
  double integral_ = 0;   ///< [N] along z: what the controller does not know of
  double calm_ = 0;       ///< [s] that the force has been right for
  double lift_from_ = 0;  ///< [m]
  struct LastTouch {
    Pose X_WT;
    double depth = 0;
  };
  std::optional<LastTouch> last_;
  std::vector<InkPoint> ink_;
  std::vector<PressedStroke> strokes_;
};

}  // namespace mjarm
