#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/session/run_output.hpp"
#include "mjarm/session/run_video.hpp"
#include "mjarm/sim/body_record.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/history.hpp"
#include "mjarm/view/live_plot.hpp"
#include "mjarm/view/playback.hpp"
#include "mjarm/view/recorded_run.hpp"
#include "mjarm/view/remote_window.hpp"
#include "mjarm/view/thinned_record.hpp"
#include "mjarm/view/view_link.hpp"

namespace mjarm::session {

/// What people see of a run: the window where there is one, the planned path and the trail, the
/// live plots. Headless it only keeps the overlay, for the picture at the end. It belongs to the
/// thread that simulates; the window is drawn by the main thread (`run_beside_windows`), and
/// nothing in it changes what is simulated but a push of the user. Steps back show what was, and
/// change nothing: a run follows its plan.
class RunShow {
 public:
  /// Opens a window unless `headless`; without a display it says so and goes on headless.
  [[nodiscard]] static Result<RunShow> open(const Model& model, const std::string& title,
                                            bool headless);

  /// Red balls at every `every`-th of the positions.
  void add_points(std::span<const Pose> X_WT, std::size_t every);
  /// Larger orange balls at places that the tool cannot get to.
  void add_unreachable(std::span<const Pose> X_WT);
  /// How the trail goes on with every call of `step`; at first it does not.
  void set_pen(render::Pen pen) { trail_.set_pen(pen); }
  /// Red balls along the trail, as the tutorial draws it.
  void set_balls(bool on) { trail_.set_balls(on); }
  /// The way of the tool as it is planned, dashed.
  void add_line(std::span<const Pose> X_WT);
  /// More that is drawn all the time.
  void add(const render::Overlay& overlay) { append(planned_, overlay); }
  /// A green ball at `p_W` [m], in the place of the one before, and a new trail: another run to
  /// another goal begins, which may set the clock back.
  void begin_goal(const Sim& sim, const Eigen::Vector3d& p_W);
  /// Live plots of the tool: its path from above, and its coordinates over time.
  void plot_tool() { plots_tool_ = true; }

  /// From now on every step is filmed into `file`, an MP4, in simulated time.
  [[nodiscard]] Result<void> film(const Model& model, const std::filesystem::path& file,
                                  const render::Camera& camera);
  /// Leaves out steps, or goes on.
  void set_filming(bool on) { filming_ = on; }
  /// Puts the video in its place, if there is one. A run that the user ends has none, which is
  /// told.
  [[nodiscard]] Result<void> end_film();
  [[nodiscard]] bool is_filming() const { return video_.has_value(); }

  /// From the next step on it is recorded how the bodies of `sim` stand.
  /// @param arm  whose tool may be led by hand afterwards; none = none may.
  void record(const Sim& sim, const Arm* arm = nullptr);
  [[nodiscard]] bool is_recording() const { return record_.has_value(); }
  /// Hands over what was recorded, if anything was, `last` at its end.
  [[nodiscard]] Result<void> end_record(const Model& model, const Snapshot& last,
                                        const RunOutput& output, const view::RunKeeper& keep);

  /// Lets the user push the bodies of `sim`, which outlives this.
  void let_push(Sim& sim) { pushed_ = &sim; }

  /// Called after each simulation step; with a window hands over a frame where one is wanted, does
  /// what the user asks for and keeps real time.
  /// @return false when the user ended it.
  [[nodiscard]] bool step(const Sim& sim, const Eigen::Vector3d& p_WT);
  /// Keeps the window open until the user closes it; returns at once without one.
  void linger(const Sim& sim);

  [[nodiscard]] bool has_window() const { return window_.has_value(); }
  /// What is planned, and the trail so far.
  [[nodiscard]] render::Overlay overlay() const;

 private:
  static constexpr std::size_t kMaxToolPoints = 2000;
  explicit RunShow(double timestep) : playback_(timestep) {}
  [[nodiscard]] std::vector<view::LivePlot> plots() const;
  void handle_events();
  void handle(const view::ViewEvent& event);
  /// Hands a frame to the window where it took the last one.
  void offer();

  std::optional<view::RemoteWindow> window_;
  view::Playback playback_;
  view::History<Snapshot> history_{2000};
  Sim* pushed_ = nullptr;
  int due_ = 0;
  bool changed_ = true;    ///< since the last frame
  view::ViewFrame frame_;  ///< memory that is used again
  bool filming_ = true;
  std::optional<VideoOfRun> video_;
  std::optional<BodyRecord> record_;
  std::string arm_;        ///< `arm_json` of what is recorded
  std::vector<int> dofs_;  ///< ... and of its joints
  render::Trail trail_{{.max_points = 10000, .pen = render::Pen::up}};
  render::Overlay planned_;
  std::optional<render::OverlaySphere> goal_;
  view::ThinnedRecord<Eigen::Vector3d> tool_{kMaxToolPoints};  ///< [m] what is plotted of it
  double last_time_ = 0;                                       ///< [s] of the last step
  bool plots_tool_ = false;
};

}  // namespace mjarm::session
