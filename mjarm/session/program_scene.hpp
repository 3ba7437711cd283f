#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mjarm/execution/presser.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/session/arm_figures.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

/// How a trail is drawn along a part of a plan.
[[nodiscard]] render::Pen pen_of(MotionPart part);

/// Draws where a plan leads the tool: along its curves, and round what stands in the way.
void add_planned_paths(render::Overlay& overlay, const MotionPlan& plan);

/// Draws what a tool that was pressed on something left there.
void add_ink(render::Overlay& overlay, std::span<const InkPoint> ink);

/// What a window shows of a program besides the arm: planned paths, the trail of the tool, the goal
/// of a motion, figures.
class ProgramScene {
 public:
  /// What of it is shown; the user chooses.
  struct Choice {
    bool paths = true;
    bool trail = true;
    bool goal = false;  ///< the arm once more, which costs as much as the arm
  };

  /// @param loaded        has no faults; outlives this.
  /// @param first_figure  number of the first item of its figures.
  ProgramScene(const program::LoadedProgram& loaded, int first_figure);

  /// One more step was made, by motion `motion` of the plan.
  /// @param time  [s] since the program was begun, for the figures.
  void add(const Sim& sim, double time, std::size_t motion, const JointVec& q_ref);
  /// Forgets the trail and the curves of the figures.
  void clear();

  /// @param motion  whose goal is shown; none = no goal is.
  [[nodiscard]] render::Overlay overlay(const Choice& choice,
                                        std::optional<std::size_t> motion) const;
  /// Those that the user chose; none before the first step.
  [[nodiscard]] std::vector<view::LivePlot> plots() const;
  [[nodiscard]] ArmFigures& figures() { return figures_; }
  [[nodiscard]] const ArmFigures& figures() const { return figures_; }

 private:
  const program::LoadedProgram* loaded_;
  render::Overlay paths_;
  render::Trail trail_;
  ArmFigures figures_;
  bool has_curves_ = false;
};

}  // namespace mjarm::session
