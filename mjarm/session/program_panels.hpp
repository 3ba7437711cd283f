#pragma once

#include <string>
#include <vector>

#include "mjarm/execution/motion_clock.hpp"
#include "mjarm/session/program_scene.hpp"
#include "mjarm/view/panel_section.hpp"

namespace mjarm::session {

/// Numbers of the items in the panel of a program; those of figures follow each other.
enum ProgramItem {
  kProgramRun,
  kProgramStep,
  kProgramStop,
  kProgramRestart,
  kProgramLines,
  kProgramTime,
  kProgramReplay,
  kProgramNow,
  kProgramPaths,
  kProgramTrail,
  kProgramGoal,
  kProgramText,
  kProgramFigure = 20,
};

/// What somebody looks at.
enum class ProgramLook {
  present,  ///< the simulation as it is
  past,     ///< a moment of the record
  replay,   ///< one moment of the record after the other
};

/// What the panel of a program tells.
struct ProgramFacts {
  MotionClock::State state = MotionClock::State::ready;
  std::size_t motion = 0;  ///< that is marked; that of no motion where all is done
  double time = 0;         ///< [s] of it that are over
  double duration = 0;     ///< [s] of it
  ProgramLook look = ProgramLook::present;
  double shown = 0;     ///< [s] of the record
  double recorded = 0;  ///< [s] all of it
  double expected = 1;  ///< [s] that it will be where nobody stops
};

/// One line a motion: "4 movel", "19 movel x3".
[[nodiscard]] std::vector<std::string> program_lines(const program::ProgramPlan& plan);

/// The sections Time, Program, Show and Plots; a long list comes after what has to be at hand.
/// @param lines  as program_lines() gives them.
/// @param plots  the section Plots.
[[nodiscard]] std::vector<view::PanelSection> program_panels(const ProgramFacts& facts,
                                                             const std::vector<std::string>& lines,
                                                             const ProgramScene::Choice& choice,
                                                             view::PanelSection plots);

}  // namespace mjarm::session
