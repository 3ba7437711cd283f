#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/view/live_plot.hpp"

namespace mjarm::view {

/// What an arm did at one time. Vectors of another size than (dof,) count as not known.
struct LiveRow {
  double time = 0;       ///< [s]
  JointVec q = {};       ///< [rad or m]
  JointVec q_ref = {};   ///< [rad or m] where the joints should be
  Pose X_WT = {};        ///< tool in the world
  Pose X_ref = {};       ///< where the tool should be
  JointVec torque = {};  ///< [N m or N] of the drives
  double manipulability = std::numeric_limits<double>::quiet_NaN();  ///< NaN = not known
};

/// The ready-made figures.
enum class LiveFigure {
  tool_position,   ///< [m] x, y, z; the reference dashed
  tracking_error,  ///< [mm] between tool and reference
  joint_error,     ///< [mrad or mm] the largest of all joints
  joints,          ///< [rad or m] with their limits dotted
  torque,          ///< [N m or N] with its limits dotted
  manipulability,
};

/// Which part of the time is shown.
enum class LiveSpan { latest, all };

/// How much is kept. Every default is usable as is.
struct LivePlotSetOptions {
  double latest = 20;        ///< [s] > 0, what LiveSpan::latest shows
  std::size_t places = 480;  ///< >= 2 places a curve for either span; a place that stands for many
                             ///< rows keeps their least and greatest value
};

/// The curves of a run in bounded memory, however long it is: figures for a window, and the same
/// curves as a page to be saved.
class LivePlotSet {
 public:
  explicit LivePlotSet(const Arm& arm, const LivePlotSetOptions& options = {});
  ~LivePlotSet();
  LivePlotSet(LivePlotSet&&) noexcept;
  LivePlotSet& operator=(LivePlotSet&&) noexcept;

  /// One row a time step; a time before the last one starts anew.
  void add(const LiveRow& row);
  void clear();

  /// A figure for a window, in English (its font is ASCII).
  [[nodiscard]] LivePlot figure(LiveFigure which, LiveSpan span = LiveSpan::latest) const;
  /// The same curves as axes of a page, in the language in use.
  [[nodiscard]] render::PlotPanel panel(LiveFigure which, LiveSpan span = LiveSpan::all) const;
  /// A page with all figures, for `save_plot`.
  [[nodiscard]] render::Plot page(const std::string& title, LiveSpan span = LiveSpan::all) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::view
