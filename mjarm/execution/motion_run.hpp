#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/execution/follow.hpp"
#include "mjarm/execution/measured_run.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/sim/recorder.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// One run of an arm, of as many motions as are wanted: its simulation, its log, and what was
/// measured; report.json is made of it. Once something ended it early, nothing moves any more.
///
///   MotionRun run(robot.model, robot.arm);
///   Result<void> done = run.execute(plan, ControlMode::computed_torque);
///   Report report = run.report(plan, run.measured_runs(), 5e-4);
class MotionRun {
 public:
  /// All stands as at keyframe `home`, else where the model begins; Sim::hold_others() keeps the
  /// joints there that are not the arm's.
  MotionRun(const Model& model, const Arm& arm);

  /// Called after every step. Returns false to end the run.
  using AfterStep = std::function<bool(const Sim& sim, MotionPart part)>;
  void set_after_step(AfterStep after_step) { after_step_ = std::move(after_step); }

  /// What all executed plans do about contacts that the joints notice.
  void set_contact(ContactReaction reaction) { contact_ = reaction; }

  /// Puts the arm at `q` (dof,), at rest.
  void start_at(std::span<const double> q);
  /// A whole plan, from its beginning. Approaches are not part of what is measured.
  [[nodiscard]] Result<void> execute(const MotionPlan& plan, ControlMode mode,
                                     double rest = kRestAtEnd);
  /// `trajectory`, and `rest` [s] at its end. With `curve`, the executed tool positions are
  /// measured against it.
  [[nodiscard]] Result<void> follow(const Trajectory& trajectory, ControlMode mode, double rest,
                                    const Curve* curve = nullptr);
  /// Joint move from where the arm is commanded to `q`; not part of what is measured.
  [[nodiscard]] Result<void> approach(std::span<const double> q, ControlMode mode);
  /// The reference jumps to `q` and stays there for `seconds`.
  [[nodiscard]] Result<void> jump(const JointVec& q, ControlMode mode, double seconds);
  /// Each waypoint is waited for: with `points` [m] the tool, else the joints. A waypoint waited
  /// for in vain ends the run with its reason.
  [[nodiscard]] Result<void> wait_through(std::span<const JointVec> waypoints,
                                          std::span<const Eigen::Vector3d> points, ControlMode mode,
                                          const Curve* curve = nullptr);

  [[nodiscard]] Sim& sim() { return sim_; }
  [[nodiscard]] const Sim& sim() const { return sim_; }
  [[nodiscard]] const Arm& arm() const { return arm_; }
  [[nodiscard]] const Recorder& recorder() const { return recorder_; }
  /// Of the strokes of plans that pressed the tool on something, in order.
  [[nodiscard]] const std::vector<InkPoint>& ink() const { return ink_; }
  [[nodiscard]] const std::vector<PressedStroke>& strokes() const { return strokes_; }
  /// What was done so far, all together.
  [[nodiscard]] const FollowOutcome& outcome() const { return total_; }
  /// The contact that the joints noticed and that ended the run, if one did.
  [[nodiscard]] const std::optional<FeltContact>& felt() const { return felt_; }
  /// Something ended the run: the user, or a waypoint that was never reached.
  [[nodiscard]] bool ended_early() const { return !end_reason_.empty(); }
  /// What was run so far, measured against the curves; they point into this.
  [[nodiscard]] std::vector<MeasuredRun> measured_runs() const;

  /// What came of it, on top of what is known already: `ok` unless it ended early, a path was not
  /// covered, or path or goal were missed by more than `tolerance` [m].
  /// @param runs  all that measured_runs() gives in the end.
  [[nodiscard]] Report report(std::span<const MeasuredRun> runs, double tolerance,
                              Report begun = {}) const;
  /// The same of an executed plan, with what was planned, what each motion did and how well the arm
  /// stands at the end. Contacts that the plan does not know withdraw `ok`, and so do objects that
  /// were moved, touched or lost.
  [[nodiscard]] Report report(const MotionPlan& plan, std::span<const MeasuredRun> runs,
                              double tolerance, Report begun = {}) const;

 private:
  /// A plan from where the arm is commanded to stand.
  [[nodiscard]] Result<void> go_on(const MotionPlan& plan, ControlMode mode, double rest);
  void add_span(const Curve* curve, double from, double to, const Pose& X_TU = {});
  /// Keeps what a motion did.
  void add(const FollowOutcome& outcome);
  [[nodiscard]] std::string why_off() const;
  void look_at_contacts(Report& report) const;
  void look_at_strokes(double tolerance, Report& report) const;

  Model model_;
  Arm arm_;
  Sim sim_;
  Recorder recorder_;
  AfterStep after_step_;
  ContactReaction contact_ = ContactReaction::ignore;
  JointVec q_command_;
  FollowOutcome total_;
  std::vector<MeasuredSpan> spans_;
  std::vector<ObservedObject> objects_;  ///< of the last plan
  std::vector<InkPoint> ink_;
  std::vector<PressedStroke> strokes_;
  std::optional<FeltContact> felt_;
  std::string end_reason_, end_detail_;
};

}  // namespace mjarm
