#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/mjarm/demos/charts.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/demos/show.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/program/motion.hpp"
#include "mjarm/sim/follow.hpp"
#include "mjarm/sim/recorder.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {

/// The robot that the user chose for a demo, with real meshes where they are asked for.
/// @param dof  number of joints the demo's postures are for; 0 = any.
[[nodiscard]] Result<Robot> load_stage_robot(const std::string& demo, const DemoOptions& options,
                                             int dof = 0);

/// A demo's world: model, arm, simulation, log, and whatever shows them. `finish` or `refuse` ends
/// it and writes the files.
class Stage {
 public:
  /// Loads the robot of `options`, makes the folder, opens the window. The arm stands at home.
  /// @param dof  number of joints the demo's postures are for; 0 = any.
  [[nodiscard]] static Result<std::unique_ptr<Stage>> open(const std::string& demo,
                                                           const DemoOptions& options, int dof = 0);
  /// The same with a robot that is loaded already.
  [[nodiscard]] static Result<std::unique_ptr<Stage>> open(const std::string& demo,
                                                           const DemoOptions& options,
                                                           const Robot& robot);

  [[nodiscard]] const Arm& arm() const { return arm_; }
  [[nodiscard]] Sim& sim() { return sim_; }
  [[nodiscard]] Show& show() { return show_; }
  /// Geometry alone: what the arm can reach.
  [[nodiscard]] const IkSolver& reach() const { return reach_; }
  /// The same without touching itself or the scene: what it may do.
  [[nodiscard]] const IkSolver& ik() const { return ik_; }
  /// The control the user chose, else `fallback`; the report names it.
  [[nodiscard]] ControlMode control(ControlMode fallback);

  /// Camera of the picture at the end, where the model has it (default: `overview`).
  void set_camera(const std::string& name) { camera_ = name; }

  /// `tick` is called after every step of the simulation.
  void set_tick(std::function<void()> tick) { tick_ = std::move(tick); }

  /// Puts the arm at `q`, at rest.
  void start_at(std::span<const double> q);
  /// Joint move from where the arm is commanded to `q`; not part of what is measured.
  [[nodiscard]] Result<void> approach(std::span<const double> q, ControlMode mode);
  /// The same along a move that is planned already, with a rest of `settle` [s] after it.
  [[nodiscard]] Result<void> approach(const Trajectory& move, ControlMode mode, double settle = 0);
  /// Runs `trajectory` and stays `settle` [s] at its end. With `curve`, the executed tool positions
  /// are measured against it.
  /// @param X_TU  the frame that is to be on the curve, in the arm's tool frame.
  [[nodiscard]] Result<void> run(const Trajectory& trajectory, ControlMode mode, double settle,
                                 const Curve* curve = nullptr, const Pose& X_TU = {});
  /// The reference jumps to `q` and stays there for `seconds`.
  [[nodiscard]] Result<void> jump(const JointVec& q, ControlMode mode, double seconds);
  /// The tutorial's followers: each waypoint is waited for. With `points` [m] the tool is waited
  /// for, else the joints. A waypoint waited for in vain ends the demo with its reason.
  [[nodiscard]] Result<void> wait_through(std::span<const JointVec> waypoints,
                                          std::span<const Eigen::Vector3d> points, ControlMode mode,
                                          const Curve* curve = nullptr);

  /// Runs `trajectory` in a world apart, from its own beginning, to compare with; nothing of it
  /// enters the report or the log.
  [[nodiscard]] Result<MeasuredRun> rehearse(const Trajectory& trajectory, ControlMode mode,
                                             const Curve& curve);
  /// What was run so far, measured against the curves; they point into the stage.
  [[nodiscard]] std::vector<MeasuredRun> measured_runs() const;
  /// Writes the page of a comparison into the folder, as comparison.png and .svg.
  [[nodiscard]] Result<void> save_comparison(const Plot& page) const;

  /// Adds a planned motion to the report and tells where its tool is slower than asked.
  void tell(const ToolMotion& motion, Report& report) const;

  /// Waypoints and trajectories that were reached so far.
  [[nodiscard]] std::size_t reached() const { return total_.reached; }
  /// Something ended the motion early: the user, or a waypoint that was never reached.
  [[nodiscard]] bool ended_early() const { return !end_reason_.empty(); }

  /// Writes report, log, plots and picture into the folder, and keeps the window open. `report`
  /// says what the demo alone knows; measured values are filled in, and `ok` is withdrawn where the
  /// path was not covered or left by more than `tolerance` [m].
  /// @param runs  all that measured_runs() gives in the end.
  [[nodiscard]] Result<Report> finish(Report report, double tolerance,
                                      std::span<const MeasuredRun> runs);
  [[nodiscard]] Result<Report> finish(Report report, double tolerance = 5e-4);
  /// Ends a demo that cannot be done, before anything moves.
  [[nodiscard]] Result<Report> refuse(std::string_view reason, const std::string& detail,
                                      Report report = {});
  [[nodiscard]] Result<Report> refuse(const MotionFailure& failure);

 private:
  struct Measured {
    std::optional<Curve> curve;
    double from = 0;  ///< [s]
    double to = 0;    ///< [s]
    Pose X_TU = {};   ///< what is measured, in the tool frame
  };

  Stage(std::string demo, const DemoOptions& options, Model model, Arm arm, Show show);
  [[nodiscard]] FollowSetup setup(Controller& controller, bool measured);
  /// Shows a step of any world; false when the user or a limit ended it.
  [[nodiscard]] bool show_step(const Sim& sim);
  using Follower = std::function<Result<FollowOutcome, FollowFailure>(const FollowSetup& setup)>;
  /// Runs one follower and keeps what it did, unless something ended the motion before.
  [[nodiscard]] Result<void> follow(ControlMode mode, bool measured, const Curve* curve,
                                    const Follower& follower);
  void add(const FollowOutcome& outcome);
  /// The camera that was chosen, where the model has it; else empty.
  [[nodiscard]] std::string known_camera() const;
  void measure(std::span<const MeasuredRun> runs, Report& report) const;
  [[nodiscard]] Result<Report> write(Report report, Plot plot);

  std::string demo_;
  DemoOptions options_;
  Model model_;
  Arm arm_;
  IkSolver reach_;
  IkSolver ik_;
  Sim sim_;
  Recorder recorder_;
  Show show_;
  JointVec q_command_;
  FollowOutcome total_;
  std::vector<Measured> measured_;
  std::string end_reason_, end_detail_;
  std::string control_;
  std::string camera_ = "overview";
  std::function<void()> tick_;
  double wall_seconds_ = 0;
};

}  // namespace mjarm::app
