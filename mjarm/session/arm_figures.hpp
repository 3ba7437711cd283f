#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mjarm/sim/sim.hpp"
#include "mjarm/view/events.hpp"
#include "mjarm/view/live_plot_set.hpp"
#include "mjarm/view/panel_section.hpp"

namespace mjarm::session {

/// Number of LiveFigure.
inline constexpr std::size_t kLiveFigures = 6;

/// The figures of an arm in a window, and which of them the user wants to see.
class ArmFigures {
 public:
  /// Shown or not, in the order of LiveFigure.
  using Choice = std::array<bool, kLiveFigures>;

  /// @param first_item  number of the first item of the section; those of the others follow.
  ArmFigures(const Arm& arm, int first_item, const Choice& shown = {});

  /// Does what an item of the section asks for.
  /// @return false where the item is of another one.
  bool handle(const view::PanelEvent& event);
  /// The section Plots: one check box a figure.
  [[nodiscard]] view::PanelSection section() const;

  /// Takes note of the arm, every 10 ms of `time`; call it after each step.
  /// @param time   [s] of the figures.
  /// @param arm    with the tool that is shown.
  /// @param q_ref  where the arm should be, shape (dof,) [rad or m]; empty = nowhere.
  void add(const Sim& sim, double time, const Arm& arm, const JointVec& q_ref);
  void clear();
  /// Those that are shown.
  [[nodiscard]] std::vector<view::LivePlot> plots() const;

 private:
  view::LivePlotSet plots_;
  int first_item_;
  Choice shown_;
  double next_row_ = 0;  ///< [s]
};

}  // namespace mjarm::session
