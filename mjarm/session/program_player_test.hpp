#pragma once

#include <string>
#include <vector>

#include "mjarm/session/program_player.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::session {

using State = MotionClock::State;

inline constexpr const char* kThereAndBack = R"(robot: ur5e
program:
  - movej: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}
  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0], speed: 0.2, blend: 10mm}
  - movel: {pos: [-0.1, -0.45, 0.3], euler: [180deg, 0, 0]}
  - wait: 100ms
  - movej: {joints: home}
)";

/// The program of all tests, planned once.
inline const program::LoadedProgram& there_and_back() {
  static const support::TempFolder folder;
  static const program::LoadedProgram loaded =
      program::load_program(folder.write("there.yaml", kThereAndBack).string()).value();
  return loaded;
}

inline ProgramPlayer new_player() { return ProgramPlayer::create(there_and_back()).value(); }

inline void press_item(ProgramPlayer& player, ProgramItem item, double value = 1) {
  player.handle(view::PanelEvent{item, value});
}

inline void make_steps(ProgramPlayer& player, int steps) {
  for (int i = 0; i < steps; ++i) player.step();
}

/// Steps until the walk is where it shall be; returns how many.
inline int steps_until(ProgramPlayer& player, State state) {
  int steps = 0;
  for (; player.clock().state() != state && steps < 20000; ++steps) player.step();
  return steps;
}

inline std::vector<double> state_shown(const ProgramPlayer& player) {
  view::ViewFrame frame;
  player.fill(frame);
  return frame.snapshot.state;
}

}  // namespace mjarm::session
