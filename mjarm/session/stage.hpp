#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/execution/motion_run.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/session/motion_view.hpp"
#include "mjarm/session/run_show.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace mjarm::session {

/// What the user chose for a run that is shown and kept.
struct StageOptions {
  std::filesystem::path out;           ///< folder of all files written
  bool headless = false;               ///< no window even where there is a display
  bool video = false;                  ///< writes video.mp4 as well
  view::RunKeeper record;              ///< of the run, recorded; empty = it is not
  bool timing = true;                  ///< wall-clock fields in the report
  Replace replace = {};                ///< what stands in the folder
  double seconds = 0;                  ///< [s] most simulated time, 0 = as long as the motion takes
  std::optional<ControlMode> control;  ///< none = what the program or the demo wants
};

/// A run of an arm with whatever shows it and the files it leaves behind. `finish` or `refuse` ends
/// it and writes them.
class Stage {
 public:
  /// Makes the folder, opens the window. The arm stands at home.
  [[nodiscard]] static Result<std::unique_ptr<Stage>> open(const std::string& name,
                                                           const StageOptions& options,
                                                           const Robot& robot);

  [[nodiscard]] const Robot& robot() const { return robot_; }
  [[nodiscard]] const Arm& arm() const { return robot_.arm; }
  [[nodiscard]] MotionRun& run() { return run_; }
  [[nodiscard]] RunShow& show() { return show_; }
  /// The control the user chose, else `fallback`; the report names it.
  [[nodiscard]] ControlMode control(ControlMode fallback);

  /// What picture and film are of, where it is known before anything moves.
  void set_outline(MotionOutline outline) { outline_ = std::move(outline); }
  /// `tick` is called after every step of the simulation.
  void set_tick(std::function<void()> tick) { tick_ = std::move(tick); }

  /// Moves the arm by a call of the run: `stage.move([&](MotionRun& run) { return run.jump(...);
  /// })`.
  template <class Motion>
  [[nodiscard]] Result<void> move(const Motion& motion) {
    if (run_.ended_early()) return {};
    if (auto filming = begin_film(); !filming) return filming;
    const Stopwatch watch;
    Result<void> done = motion(run_);
    wall_seconds_ += 1e-6 * watch.us();
    return done;
  }
  /// Runs `trajectory` in a world apart, from its own beginning, to compare with; nothing of it
  /// enters the report or the log.
  [[nodiscard]] Result<MeasuredRun> rehearse(const Trajectory& trajectory, ControlMode mode,
                                             const Curve& curve);
  /// Writes the page of a comparison into the folder, as comparison.png and .svg.
  [[nodiscard]] Result<void> save_comparison(const render::Plot& page) const;

  /// Tells the joint that a motion leads beyond what its servo can be told, if it does.
  void tell_servos(const Trajectory& motion) const;
  /// Adds a planned motion to the report; tells that, and where its tool is slower than asked.
  void tell(const ToolMotion& motion, Report& report) const;

  /// Writes report, log, plots and picture into the folder, and keeps the window open.
  /// @param report     as the run gives it with `tolerance`.
  /// @param tolerance  [m] drawn into the plots.
  /// @param runs       all that was measured.
  [[nodiscard]] Result<Report> finish(Report report, double tolerance,
                                      std::span<const MeasuredRun> runs);
  /// The same with what the run says of itself on top of what is known already.
  [[nodiscard]] Result<Report> finish(Report begun, double tolerance = 5e-4);
  /// Ends a run that cannot be done, before anything moves.
  [[nodiscard]] Result<Report> refuse(std::string_view reason, const std::string& detail,
                                      Report report = {});
  [[nodiscard]] Result<Report> refuse(const MotionFailure& failure);

 private:
  Stage(std::string name, const StageOptions& options, const Robot& robot, RunShow show);
  /// Shows a step of any world; false when the user or a limit ended it.
  [[nodiscard]] bool show_step(const Sim& sim);
  [[nodiscard]] Result<void> begin_film();
  [[nodiscard]] render::Camera camera() const;
  [[nodiscard]] Result<Report> write(Report report, render::Plot plot);

  std::string name_;
  StageOptions options_;
  Robot robot_;
  MotionRun run_;
  RunShow show_;
  std::optional<OutputFolder> folder_;  // held as long as it is written to
  std::string control_;
  std::optional<MotionOutline> outline_;
  std::function<void()> tick_;
  double wall_seconds_ = 0;
};

}  // namespace mjarm::session
