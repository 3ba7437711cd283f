#pragma once

#include <string>
#include <vector>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

/// Which robot, and which frame of it is the tool.
struct RobotChoice {
  std::string robot = {};                       ///< name of a shipped model, or path
  std::string tip = {};                         ///< empty = the robot's own
  std::vector<std::string> package_paths = {};  ///< where `package://NAME` is looked for first
  bool allow_outside = false;                   ///< as in LoadOptions
  bool looks = true;                            ///< as in LoadOptions
};

/// Adds `--package-path DIR`, which may be given several times, bound to `folders`.
void add_package_path_option(CLI::App& app, std::vector<std::string>& folders);

/// Adds `--allow-outside`, bound to `allowed`.
void add_outside_option(CLI::App& app, bool& allowed);

/// Adds both, which say how the files of a robot are read.
void add_load_options(CLI::App& app, RobotChoice& options);
/// What they say.
[[nodiscard]] LoadOptions load_options(const RobotChoice& choice);

/// Adds `--robot ROBOT`, `--tip FRAME`, `--package-path DIR` and `--allow-outside`, bound to
/// `options`.
void add_robot_options(CLI::App& app, RobotChoice& options);

/// Finds and loads a model, which need not have an arm; `options.tip` does not matter.
[[nodiscard]] Result<Model> load_model(const RobotChoice& options);

/// Logs what a user who looks at the model wants to know about how it was read.
void tell_warnings(const Model& model);

/// Finds, loads and searches the robot; a usage error where `--robot` is missing.
[[nodiscard]] Result<Robot> load_robot(const RobotChoice& options);

}  // namespace mjarm::app
