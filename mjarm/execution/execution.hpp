#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/contact_guard.hpp"
#include "mjarm/execution/motion_clock.hpp"
#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/execution/object_watch.hpp"
#include "mjarm/execution/presser.hpp"
#include "mjarm/sim/recorder.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/sim/stepper.hpp"

namespace mjarm {

/// How a plan is executed. Every default is usable as is.
struct ExecutionOptions {
  ControlMode control = ControlMode::computed_torque;
  ContactReaction contact = ContactReaction::ignore;  ///< to what the joints feel
  double rest = kRestAtEnd;                           ///< [s] >= 0 after the last motion
  Recorder* recorder = nullptr;  ///< gets every step; outlives the execution; null = nobody records
};

/// Of the motion in which the gripper closes or opens, the part in which its command changes.
inline constexpr double kGripShare = 0.6;

/// A motion that was begun, and what it did.
struct ExecutedMotion {
  std::size_t move = 0;  ///< index in the plan
  double from = 0;       ///< [s] of the simulation
  double to = 0;         ///< [s] its end; up to now where it is on its way
  FollowOutcome outcome;
};

/// Moves an arm in a simulation along the motions of a plan: the one driver of all faces. Either
/// step by step, to be stopped and taken up again as a user likes, or all in one call. What the
/// gripper is told to do is told over the first kGripShare of that motion, at a steady rate:
/// fingers that are thrown shut throw what they hold. The controller knows the mass of what the
/// plan has in the gripper, as if it hung at the tool frame, and the plan's payloads, which the
/// simulation gets as well. The arm goes on from where it stands;
/// Sim::place() puts it at the plan's start.
class Execution {
 public:
  using State = MotionClock::State;

  /// @param model  of the simulations that are stepped, without payload.
  /// @param plan   outlives this.
  /// @return an error where the arm's actuators cannot do that control, a motion is not one of
  ///         this arm, or it has no gripper to close.
  [[nodiscard]] static Result<Execution> create(const Model& model, const MotionPlan& plan,
                                                const ExecutionOptions& options = {});

  /// To the end of all motions, of the current one, to rest, back to the start; step() does it.
  void run() { clock_.run(); }
  void run_one() { clock_.run_one(); }
  void stop() { clock_.stop(); }
  void restart();

  /// One time step: along the plan where it runs, else the arm is held where it should be.
  /// @param sim  the same one every time.
  /// @return an error where the simulation broke down; it stands in its initial state then.
  [[nodiscard]] Result<void> step(Sim& sim);

  /// Called after every step (window, progress, Ctrl-C); returns false to stop.
  using AfterStep = std::function<bool(const Sim& sim)>;
  /// All that is left, to the end.
  /// @param after_step  may be empty.
  /// @return what was done so far in all, `stopped` where `after_step` asked for the end; an error
  ///         where the simulation broke down.
  [[nodiscard]] Result<FollowOutcome> run_to_end(Sim& sim, const AfterStep& after_step = {});

  [[nodiscard]] const MotionPlan& plan() const { return *plan_; }
  [[nodiscard]] const MotionClock& clock() const { return clock_; }
  [[nodiscard]] State state() const { return clock_.state(); }
  /// What the motion is that was begun last; of a tool that presses, work only while it does.
  [[nodiscard]] MotionPart part() const;
  /// The motions that were begun since the start, in order.
  [[nodiscard]] const std::vector<ExecutedMotion>& motions() const { return motions_; }
  /// What all of them did together; its first contact is one that the plan does not know.
  [[nodiscard]] FollowOutcome outcome() const;
  /// (dof,) [rad or m] How far the joints are from the reference of the last step; zeros before the
  /// first.
  [[nodiscard]] JointVec error(const Sim& sim) const;
  /// Of a plan that presses the tool on something.
  [[nodiscard]] const std::optional<Presser>& presser() const { return presser_; }
  /// The contact that its joints noticed and that ended it (ContactReaction::stop), if one did.
  [[nodiscard]] std::optional<FeltContact> felt() const {
    return guard_ ? guard_->contact() : std::nullopt;
  }
  /// What became of the objects of the scene.
  [[nodiscard]] std::vector<ObservedObject> objects() const { return watch_.objects(); }

 private:
  Execution(const Model& model, const MotionPlan& plan, Controller controller,
            const ExecutionOptions& options);
  /// What the next step is; the gripper is told what it has to do from then on.
  [[nodiscard]] MotionClock::Step next(Sim& sim);
  [[nodiscard]] Result<void> make_step(Sim& sim, const MotionClock::Step& step);
  void move_gripper(Sim& sim);
  void feel(const Sim& sim, std::size_t motion);
  [[nodiscard]] bool reacts() const { return guard_ && guard_->contact(); }
  /// Of what is carried now, or of the empty hand.
  [[nodiscard]] Controller& controller() { return loaded_ ? *loaded_ : controller_; }
  void take_load(Sim& sim, std::size_t move);
  void begin_motion(Sim& sim, std::size_t move, double from);
  void end_motion(const Sim& sim);
  void take_measures(const Sim& sim);

  /// The command of the gripper on its way.
  struct GripWay {
    std::vector<double> from;  ///< one entry a drive
    double grip = 0;           ///< where it goes, 0 open to 1 closed
    int steps = 0, done = 0;
  };

  const MotionPlan* plan_;
  Model model_;             ///< of the robot without payload
  ControlOptions control_;  ///< of all its controllers
  ExecutionOptions options_;
  Controller controller_;             ///< of the empty hand
  std::optional<Controller> loaded_;  ///< of what is carried now, as far as that is known
  double load_ = 0;                   ///< [kg] of what is attached
  Payload payload_;                   ///< what hangs at the tool beside it
  MotionClock clock_;
  std::optional<Presser> presser_;
  std::optional<Stepper> stepper_;
  std::vector<ExecutedMotion> motions_;
  ObjectWatch watch_;
  std::optional<GripWay> grip_;
  std::optional<ContactGuard> guard_;   ///< where contacts are not ignored
  std::optional<std::size_t> gripped_;  ///< the last motion in which the gripper moved
};

}  // namespace mjarm
