#pragma once

#include <span>
#include <string>

#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/session/stage.hpp"

namespace mjarm::app {

/// What the user chose for a demo.
struct DemoOptions : session::StageOptions {
  RobotChoice robot;    ///< which arm, and which frame of it is the tool
  bool meshes = false;  ///< the robot's real meshes, which must be installed
  bool guide = false;   ///< do it the tutorial's way
  std::string text;     ///< for `letters`
};

/// What a demo takes besides --out, --overwrite, --headless, --video and --no-timing; whatever else
/// is given is refused.
enum DemoUse : unsigned {
  kUseRobot = 1,     ///< --robot, --tip
  kUseFiles = 2,     ///< --package-path, --allow-outside
  kUseMeshes = 4,    ///< --meshes
  kUseSeconds = 8,   ///< --seconds
  kUseControl = 16,  ///< --control
  kUseGuide = 32,    ///< --guide
  kUseText = 64,     ///< --text
};

/// One demo. `run` makes the motion and writes its files; a report with `ok` false is a demo that
/// ended with a reason (exit code 1), an Error one that could not start.
struct Demo {
  const char* name;
  Msg summary;
  Result<Report> (*run)(const DemoOptions& options);
  unsigned uses;         ///< of DemoUse
  const char* examples;  ///< for its help
};

/// All demos, in the order in which a newcomer would try them.
[[nodiscard]] std::span<const Demo> demos();

Result<Report> run_car(const DemoOptions& options);
Result<Report> run_ur5e(const DemoOptions& options);
Result<Report> run_ur5e_vision(const DemoOptions& options);
Result<Report> run_point(const DemoOptions& options);
Result<Report> run_movej(const DemoOptions& options);
Result<Report> run_movel(const DemoOptions& options);
Result<Report> run_ellipse(const DemoOptions& options);
Result<Report> run_letters(const DemoOptions& options);
Result<Report> run_singularity(const DemoOptions& options);
Result<Report> run_flip(const DemoOptions& options);
Result<Report> run_avoid(const DemoOptions& options);
Result<Report> run_square(const DemoOptions& options);
Result<Report> run_reach(const DemoOptions& options);

}  // namespace mjarm::app
