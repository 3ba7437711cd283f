#include "mjarm/session/program_panels.hpp"

#include <algorithm>
#include <cstdio>

namespace mjarm::session {
namespace {

constexpr const char* kProgramStateWords[] = {"ready", "running", "stopping", "stopped", "done"};
constexpr const char* kProgramLookWords[] = {"now", "the past", "replay"};

view::PanelItem program_button(ProgramItem item, const char* name, bool enabled = true) {
  return {item, name, view::PanelButton{}, enabled};
}

view::PanelItem program_checkbox(int item, const char* name, bool on) {
  return {item, name, view::PanelCheckbox{on}};
}

view::PanelItem program_line(const char* name, std::string value) {
  return {kProgramText, name, view::PanelText{std::move(value)}};
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
  return {"Program",
          {program_button(kProgramRun, "Run", !done),
           program_button(kProgramStep, "Step", !done),
           program_button(kProgramStop, "Stop"),
           program_button(kProgramRestart, "Restart"),
           program_line("State", kProgramStateWords[static_cast<int>(facts.state)]),
           program_line("Motion", part_of(facts.time, facts.duration)),
           {kProgramLines, "",
            view::PanelList{lines, static_cast<int>(std::min(facts.motion, last))}}}};
}

view::PanelSection time_section(const ProgramFacts& facts) {
  // The line gets longer in a few large steps: with each of them the panel is made anew.
  double end = std::max(facts.expected, 1.0);
  while (end < facts.recorded) end *= 1.5;
  return {"Time",
          {{kProgramTime, "", view::PanelTimeline{facts.shown, end}},
           program_button(kProgramReplay, "Replay"),
           program_button(kProgramNow, "Now"),
           program_line("Shown", kProgramLookWords[static_cast<int>(facts.look)]),
           program_line("Time", part_of(facts.shown, facts.recorded))}};
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
  return {time_section(facts), program_section(facts, lines),
          view::PanelSection{"Show",
                             {program_checkbox(kProgramPaths, "Planned paths", choice.paths),
                              program_checkbox(kProgramTrail, "Trail", choice.trail),
                              program_checkbox(kProgramGoal, "Goal", choice.goal)}},
          std::move(plots)};
}

}  // namespace mjarm::session
