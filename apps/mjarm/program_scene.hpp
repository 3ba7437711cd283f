#pragma once

#include <array>
#include <optional>
#include <vector>

#include "apps/mjarm/plan_walk.hpp"
#include "apps/mjarm/program_load.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/view/live_plot_set.hpp"

namespace mjarm::app {

/// Number of LiveFigure.
inline constexpr std::size_t kLiveFigures = 6;

/// What a window shows of a program besides the arm: planned paths, the trail of the tool, the goal
/// of a motion, figures.
class ProgramScene {
 public:
  /// What of it is shown; the user chooses.
  struct Choice {
    bool paths = true;
    bool trail = true;
    bool goal = false;  ///< the arm once more, which costs as much as the arm
    std::array<bool, kLiveFigures> figures = {true, true};  ///< in the order of LiveFigure
  };

  /// @param loaded  has no faults; outlives this.
  explicit ProgramScene(const LoadedProgram& loaded);

  /// One more step was made, by motion `motion` of the plan.
  /// @param time  [s] since the program was begun, for the figures.
  void add(const Sim& sim, double time, std::size_t motion, const JointVec& q_ref);
  /// Forgets the trail and the curves of the figures.
  void clear();

  /// @param motion  whose goal is shown; none = no goal is.
  [[nodiscard]] Overlay overlay(const Choice& choice, std::optional<std::size_t> motion) const;
  /// None before the first step.
  [[nodiscard]] std::vector<LivePlot> figures(const Choice& choice) const;

 private:
  const LoadedProgram* loaded_;
  Overlay paths_;
  Trail trail_;
  LivePlotSet plots_;
  bool has_curves_ = false;
};

}  // namespace mjarm::app
