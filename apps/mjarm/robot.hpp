#pragma once

#include <string>
#include <vector>

#include "apps/mjarm/options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::app {

/// Which robot, and which frame of it is the tool.
struct RobotOptions {
  std::string robot;                            ///< name of a shipped model, or path
  std::string tip = {};                         ///< empty = the robot's own
  std::vector<std::string> package_paths = {};  ///< where `package://NAME` is looked for first
  bool allow_outside = false;                   ///< as in LoadOptions
};

/// Adds `--package-path DIR`, which may be given several times, bound to `folders`.
void add_package_path_option(CLI::App& app, std::vector<std::string>& folders);

/// Adds `--allow-outside`, bound to `allowed`.
void add_outside_option(CLI::App& app, bool& allowed);

/// Adds `--robot ROBOT`, `--tip FRAME`, `--package-path DIR` and `--allow-outside`, bound to
/// `options`.
void add_robot_options(CLI::App& app, RobotOptions& options);

/// A loaded robot.
struct Robot {
  Model model;
  Arm arm;
};

/// Finds and loads a model, which need not have an arm; `options.tip` does not matter.
[[nodiscard]] Result<Model> load_model(const RobotOptions& options);

/// Logs what a user who looks at the model wants to know about how it was read.
void tell_warnings(const Model& model);

/// Finds, loads and searches the robot; a usage error where `--robot` is missing.
[[nodiscard]] Result<Robot> load_robot(const RobotOptions& options);

}  // namespace mjarm::app
