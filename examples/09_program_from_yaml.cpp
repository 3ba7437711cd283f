// A motion program from a YAML file: read, planned, executed in MuJoCo, measured, reported.
#include <cstdio>

#include "mjarm/execution/motion_run.hpp"
#include "mjarm/program/load_program.hpp"

int main(int argc, char** argv) {
  // A path, or the name of a shipped program.
  const auto loaded = mjarm::program::load_program(argc > 1 ? argv[1] : "ellipse");
  if (!loaded) return std::fprintf(stderr, "%s\n", loaded.error().what.c_str()), 1;
  for (const mjarm::program::ProgramFault& fault : loaded->plan.faults) {
    std::fprintf(stderr, "%s\n", line_of(*loaded, fault).c_str());
  }
  if (!loaded->plan.ok()) return 1;

  mjarm::MotionRun run(loaded->robot.model, loaded->robot.arm);
  const auto done = run.execute(loaded->plan, mjarm::ControlMode::computed_torque);
  if (!done) return std::fprintf(stderr, "%s\n", done.error().what.c_str()), 1;
  const mjarm::Report report = run.report(loaded->plan, run.measured_runs(), 5e-4);  // [m]
  std::printf("%s", to_json(report).c_str());
  return report.ok ? 0 : 1;
}
