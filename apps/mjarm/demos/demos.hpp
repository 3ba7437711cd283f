#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/session/stage.hpp"

namespace mjarm::app {

/// What the user changes of a demo; whatever is not given stays as the demo has it.
struct DemoValues {
  std::optional<Eigen::Vector3d> to;        ///< [m] where the tool goes
  std::optional<Eigen::Vector3d> from;      ///< [m] where a line begins
  std::optional<Eigen::Matrix3d> R;         ///< orientation of the tool
  std::optional<Eigen::Vector3d> center;    ///< [m] middle of what is drawn
  std::optional<Eigen::Vector3d> normal;    ///< of the plane drawn in, any length but zero
  std::optional<double> a, b;               ///< [m] semi-axes, > 0
  std::optional<double> height;             ///< [m] of a letter, > 0
  std::string text;                         ///< to be written
  std::uint64_t seed = 1;                   ///< of what is drawn at random
  std::string seed_q, start, joints, ctrl;  ///< one value a joint, for `parse_joints`

  /// Whether the user changes where the tool goes.
  [[nodiscard]] bool of_geometry() const {
    return to || from || R || center || normal || a || b || height || !text.empty() ||
           !joints.empty();
  }
};

/// What the user chose for a demo.
struct DemoOptions : session::StageOptions {
  RobotChoice robot;               ///< which arm, and which frame of it is the tool
  bool meshes = false;             ///< the robot's real meshes, which must be installed
  bool guide = false;              ///< do it the tutorial's way
  std::vector<std::string> allow;  ///< `A,B`: bodies or geoms that may touch
  DemoValues values;
};

/// What a demo takes besides --out, --overwrite, --headless, --video and --no-timing; whatever else
/// is given is refused.
enum DemoUse : unsigned {
  kUseRobot = 1,          ///< --robot, --tip
  kUseFiles = 2,          ///< --package-path, --allow-outside
  kUseMeshes = 4,         ///< --meshes
  kUseSeconds = 8,        ///< --seconds
  kUseControl = 16,       ///< --control
  kUseGuide = 32,         ///< --guide
  kUseText = 64,          ///< --text, --height
  kUsePos = 128,          ///< --pos
  kUseOrientation = 256,  ///< --euler, --quat
  kUseSeed = 512,         ///< --seed-q
  kUseTo = 1024,          ///< --to
  kUseFrom = 2048,        ///< --from
  kUseJoints = 4096,      ///< --joints
  kUseCtrl = 8192,        ///< --ctrl, --start
  kUsePlane = 16384,      ///< --center, --normal
  kUseAxes = 32768,       ///< --a, --b, --radius
  kUseAllow = 65536,      ///< --allow
  kUseDraw = 131072,      ///< --seed
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
Result<Report> run_calligraphy(const DemoOptions& options);
Result<Report> run_singularity(const DemoOptions& options);
Result<Report> run_flip(const DemoOptions& options);
Result<Report> run_avoid(const DemoOptions& options);
Result<Report> run_pick_place(const DemoOptions& options);
Result<Report> run_sort(const DemoOptions& options);
Result<Report> run_square(const DemoOptions& options);
Result<Report> run_reach(const DemoOptions& options);

}  // namespace mjarm::app
