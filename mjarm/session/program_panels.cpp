#include "mjarm/session/program_panels.hpp"

#include <algorithm>
#include <cstdio>

#include "mjarm/core/messages/panels.hpp"

namespace mjarm::session {
namespace {

constexpr Msg kProgramStateWords[] = {msg::panel_ready, msg::panel_running, msg::panel_stopping,
                                      msg::panel_stopped, msg::panel_done};
constexpr Msg kProgramLookWords[] = {msg::panel_now, msg::panel_past, msg::panel_replay};

view::PanelItem program_button(ProgramItem item, Msg name, bool enabled = true) {
  return {item, text(name), view::PanelButton{}, enabled};
}

view::PanelItem program_checkbox(int item, Msg name, bool on) {
  return {item, text(name), view::PanelCheckbox{on}};
}

view::PanelItem program_line(Msg name, std::string value) {
  return {kProgramText, text(name), view::PanelText{std::move(value)}};
}

std::string part_of(double part, double whole) {
  char text[48];
  std::snprintf(text, sizeof(text), "%.1f / %.1f s", part, whole);
  return text;
}

view::PanelSection program_section(const ProgramFacts& facts,
                                   const std::vector<std::string>& lines) {
  const bool done = facts.state == MotionClock::State::done;
  const std::size_t last = lines.empty() ? 0 : lines.size() - 1;
  return {text(msg::panel_program),
          {program_button(kProgramRun, msg::panel_run, !done),
           program_button(kProgramStep, msg::panel_step, !done),
           program_button(kProgramStop, msg::panel_stop),
           program_button(kProgramRestart, msg::panel_restart),
           program_line(msg::panel_state, text(kProgramStateWords[static_cast<int>(facts.state)])),
           program_line(msg::panel_motion, part_of(facts.time, facts.duration)),
           {kProgramLines, "",
            view::PanelList{lines, static_cast<int>(std::min(facts.motion, last))}}}};
}

view::PanelSection time_section(const ProgramFacts& facts) {
  // The line gets longer in a few large steps: with each of them the panel is made anew.
  double end = std::max(facts.expected, 1.0);
  while (end < facts.recorded) end *= 1.5;
  return {text(msg::panel_time),
          {{kProgramTime, "", view::PanelTimeline{facts.shown, end}},
           program_button(kProgramReplay, msg::panel_replay_button),
           program_button(kProgramNow, msg::panel_now_button),
           program_line(msg::panel_shown, text(kProgramLookWords[static_cast<int>(facts.look)])),
           program_line(msg::panel_time, part_of(facts.shown, facts.recorded))}};
}

}  // namespace

std::vector<std::string> program_lines(const program::ProgramPlan& plan) {
  std::vector<std::string> lines;
  for (const PlannedMove& move : plan.moves) {
    std::string& line = lines.emplace_back(std::to_string(move.place.line) + " " + move.word);
    if (move.instructions > 1) line += " x" + std::to_string(move.instructions);
  }
  return lines;
}

std::vector<view::PanelSection> program_panels(const ProgramFacts& facts,
                                               const std::vector<std::string>& lines,
                                               const ProgramScene::Choice& choice,
                                               view::PanelSection plots) {
  return {
      time_section(facts), program_section(facts, lines),
      view::PanelSection{text(msg::panel_show),
                         {program_checkbox(kProgramPaths, msg::panel_planned_paths, choice.paths),
                          program_checkbox(kProgramTrail, msg::panel_trail, choice.trail),
                          program_checkbox(kProgramGoal, msg::panel_goal, choice.goal)}},
      std::move(plots)};
}

}  // namespace mjarm::session
