#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/live_plot.hpp"
#include "mjarm/view/real_time.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::app {

/// What people see of a demo: the window where there is one, the planned path and the trail, the
/// live plots. Headless it only keeps the overlay, for the picture at the end.
class Show {
 public:
  /// Opens a window unless `headless`; without a display it says so and goes on headless.
  [[nodiscard]] static Result<Show> open(const Model& model, const std::string& title,
                                         bool headless);

  /// Red balls at every `every`-th of the positions.
  void add_points(std::span<const Pose> X_WT, std::size_t every);
  /// The trail grows with every call of `step` while on.
  void set_trail(bool on) { trail_on_ = on; }
  /// Red balls along the trail, as the tutorial draws it.
  void set_balls(bool on) { trail_as_balls_ = on; }
  /// A tube along straight pieces.
  void add_line(std::span<const Pose> X_WT);
  /// Live plots of the tool: its path from above, and its coordinates over time.
  void plot_tool();

  /// Called after each simulation step; draws where a frame is due and keeps real time with a
  /// window.
  /// @return false when the user ended it.
  [[nodiscard]] bool step(const Sim& sim, const Eigen::Vector3d& p_WT);
  /// Keeps the window open until the user closes it; returns at once without one.
  void linger(const Sim& sim);

  [[nodiscard]] bool has_window() const { return window_.has_value(); }
  [[nodiscard]] const Overlay& overlay() const { return overlay_; }

 private:
  explicit Show(double timestep) : pacer_(timestep) {}
  void grow_trail(const Eigen::Vector3d& p_WT);
  void grow_plots(double time, const Eigen::Vector3d& p_WT);

  std::optional<Window> window_;
  RealTimePacer pacer_;
  int due_ = 0;
  bool trail_on_ = false;
  bool trail_as_balls_ = false;
  Overlay overlay_;
  std::vector<LivePlot> plots_;
};

}  // namespace mjarm::app
