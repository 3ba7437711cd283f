#pragma once

#include <string>
#include <utility>

#include "mjarm/program/load_program.hpp"
#include "mjarm/program/program_reader.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::testing {

/// A Panda, a part of 40 x 40 x 80 mm that stands on the floor on one side of a fence, and room for
/// it on the other side.
struct PartAndFence {
  double friction = 1.5;  ///< of the part
  double fence = 0.25;    ///< [m] its height
  std::string more = {};  ///< what else stands there

  [[nodiscard]] std::string scene() const {
    return R"(<mujoco model="cell"><include file="franka_emika_panda/panda.xml"/>
  <include file="scenes/studio.xml"/>
  <worldbody>
    <body name="part" pos="0.5 -0.2 0.04"><freejoint/>
      <geom name="part" type="box" size="0.02 0.02 0.04" mass="0.03" priority="2" friction=")" +
           std::to_string(friction) + R"("/></body>
    <geom name="fence" type="box" size="0.3 0.01 )" +
           std::to_string(fence / 2) + R"(" pos="0.5 0 )" + std::to_string(fence / 2) + R"("/>)" +
           more + R"(
  </worldbody></mujoco>)";
  }
};

/// The tool down at a place.
inline std::string pose_at(double x, double y, double z) {
  return "{pos: [" + std::to_string(x) + ", " + std::to_string(y) + ", " + std::to_string(z) +
         "], euler: [180deg, 0, 0]}";
}

/// To the part, and in the last line it is held.
inline std::string pick_up() {
  return "  - grip: open\n  - movej: " + pose_at(0.5, -0.2, 0.2) +
         "\n  - movel: " + pose_at(0.5, -0.2, 0.06) + "\n  - grip: close\n";
}

/// Reads and plans a program in that scene.
inline program::LoadedProgram planned(const PartAndFence& cell, const std::string& instructions) {
  const support::TempFolder folder;
  folder.write("cell.xml", cell.scene());
  const auto file =
      folder.write("job.yaml", "robot: panda\nscene: cell.xml\nprogram:\n" + instructions);
  return program::load_program(file.string()).value();
}

/// The same by somebody who never looks at contact.
inline program::LoadedProgram planned_blindly(const PartAndFence& cell,
                                              const std::string& instructions) {
  const support::TempFolder folder;
  folder.write("cell.xml", cell.scene());
  program::Program program =
      program::parse_program("scene: cell.xml\nprogram:\n" + instructions, "job.yaml").value();
  Robot robot = program::load_program_robot(program, folder.path() / "job.yaml").value();
  program::ProgramPlan plan =
      program::plan_program(robot.model, robot.arm, program, {.collision = false});
  return {"job.yaml", std::move(program), std::move(robot), std::move(plan)};
}

}  // namespace mjarm::testing
