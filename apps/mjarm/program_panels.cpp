#include "apps/mjarm/program_panels.hpp"

#include <algorithm>
#include <cstdio>

namespace mjarm::app {
namespace {

constexpr const char* kStateWords[] = {"ready", "running", "stopping", "stopped", "done"};
constexpr const char* kLookWords[] = {"now", "the past", "replay"};
constexpr const char* kFigureWords[kLiveFigures] = {
    "Tool position", "Tracking error", "Joint error", "Joints", "Torque", "Manipulability"};

PanelItem button(ProgramItem item, const char* name, bool enabled = true) {
  return {item, name, PanelButton{}, enabled};
}

PanelItem checkbox(int item, const char* name, bool on) { return {item, name, PanelCheckbox{on}}; }

PanelItem line(const char* name, std::string value) {
  return {kTextItem, name, PanelText{std::move(value)}};
}

std::string times(double part, double whole) {
  char text[48];
  std::snprintf(text, sizeof(text), "%.1f / %.1f s", part, whole);
  return text;
}

PanelSection program_section(const ProgramFacts& facts, const std::vector<std::string>& lines) {
  const bool done = facts.state == PlanWalk::State::done;
  const std::size_t last = lines.empty() ? 0 : lines.size() - 1;
  return {"Program",
          {button(kRunItem, "Run", !done),
           button(kStepItem, "Step", !done),
           button(kStopItem, "Stop"),
           button(kRestartItem, "Restart"),
           line("State", kStateWords[static_cast<int>(facts.state)]),
           line("Motion", times(facts.time, facts.duration)),
           {kLinesItem, "", PanelList{lines, static_cast<int>(std::min(facts.motion, last))}}}};
}

PanelSection time_section(const ProgramFacts& facts) {
  // The line gets longer in a few large steps: with each of them the panel is made anew.
  double end = std::max(facts.expected, 1.0);
  while (end < facts.recorded) end *= 1.5;
  return {"Time",
          {{kTimeItem, "", PanelTimeline{facts.shown, end}},
           button(kReplayItem, "Replay"),
           button(kNowItem, "Now"),
           line("Shown", kLookWords[static_cast<int>(facts.look)]),
           line("Time", times(facts.shown, facts.recorded))}};
}

}  // namespace

std::vector<std::string> program_lines(const ProgramPlan& plan) {
  std::vector<std::string> lines;
  for (const PlannedMove& move : plan.moves) {
    std::string& line = lines.emplace_back(std::to_string(move.place.line) + " " + move.word);
    if (move.instructions > 1) line += " x" + std::to_string(move.instructions);
  }
  return lines;
}

std::vector<PanelSection> program_panels(const ProgramFacts& facts,
                                         const std::vector<std::string>& lines,
                                         const ProgramScene::Choice& choice) {
  PanelSection plots{"Plots", {}};
  for (std::size_t i = 0; i < kLiveFigures; ++i) {
    plots.items.push_back(
        checkbox(kFigureItem + static_cast<int>(i), kFigureWords[i], choice.figures[i]));
  }
  return {time_section(facts), program_section(facts, lines),
          PanelSection{"Show",
                       {checkbox(kPathsItem, "Planned paths", choice.paths),
                        checkbox(kTrailItem, "Trail", choice.trail),
                        checkbox(kGoalItem, "Goal", choice.goal)}},
          std::move(plots)};
}

}  // namespace mjarm::app
