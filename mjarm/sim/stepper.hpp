#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/sim/recorder.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// The first time the arm, or what it carries along, touched something.
struct TimedContact {
  Contact contact;
  double time = 0;  ///< [s] of the simulation
};

/// What a run did. Errors and uses are taken at every step, at its end.
struct FollowOutcome {
  std::size_t reached = 0;  ///< waypoints that were reached; 1 at the end of a trajectory
  long long steps = 0;
  double duration = 0;          ///< [s] simulated
  bool stopped = false;         ///< somebody asked for the end
  double worst_error = 0;       ///< [rad or m] largest |q_ref - q| of any joint
  double final_error = 0;       ///< [rad or m] the same at the end
  double final_tool_error = 0;  ///< [m] distance of the tool from where q_ref puts it, at the end
  double velocity_use = 0;      ///< largest share of a joint's velocity limit
  double torque_use = 0;        ///< largest share of a joint's torque limit
  long long limited_steps = 0;  ///< steps in which a ctrl or force limit cut the command
  std::optional<TimedContact> first_contact;

  /// Goes on with what was done after it.
  void add(const FollowOutcome& next);
};

/// The one way to make a step under control: command, step, record, measure. Actuators that are not
/// the arm's keep the ctrl they have (Sim::set_ctrl) or hold their joint (Sim::hold_others).
class Stepper {
 public:
  /// A motion begins: what is measured counts from here.
  /// @param arm  outlives this.
  Stepper(const Sim& sim, const Arm& arm);

  /// One step towards `reference`.
  /// @param recorder  gets the state before the first step and after every step; may be null.
  /// @return an error where the simulation broke down.
  [[nodiscard]] Result<void> step(Sim& sim, Controller& controller, const StepReference& reference,
                                  Recorder* recorder);

  /// Outcome so far, with the errors at this moment against the reference of the last step.
  [[nodiscard]] FollowOutcome outcome(const Sim& sim) const;
  /// How far each joint is from the reference of the last step, q_ref - q.
  [[nodiscard]] JointVec error(const Sim& sim) const;
  [[nodiscard]] bool limited() const { return limited_; }  ///< in the last step
  void reached_one() { ++outcome_.reached; }

 private:
  void measure(const Sim& sim);

  const Arm* arm_;
  FollowOutcome outcome_;
  std::vector<double> ctrl_;
  JointVec q_ref_;
  double start_;
  bool limited_ = false;
  bool broken_ = false;
};

}  // namespace mjarm
