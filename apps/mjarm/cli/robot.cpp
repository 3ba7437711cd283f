#include "apps/mjarm/cli/robot.hpp"

#include <utility>

#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/log.hpp"

namespace mjarm::app {

LoadOptions load_options(const RobotChoice& choice) {
  return {.package_paths = {choice.package_paths.begin(), choice.package_paths.end()},
          .allow_outside = choice.allow_outside,
          .looks = choice.looks};
}

void add_outside_option(CLI::App& app, bool& allowed) {
  add_flag(app, "--allow-outside", allowed, msg::app_option_outside);
}

void add_robot_options(CLI::App& app, RobotChoice& options) {
  add_option(app, "--robot", options.robot, msg::app_option_robot, "ROBOT");
  add_option(app, "--tip", options.tip, msg::app_option_tip, "FRAME");
  add_load_options(app, options);
}

void add_load_options(CLI::App& app, RobotChoice& options) {
  add_package_path_option(app, options.package_paths);
  add_outside_option(app, options.allow_outside);
}

void add_package_path_option(CLI::App& app, std::vector<std::string>& folders) {
  add_option(app, "--package-path", folders, msg::app_option_package_path, "DIR");
}

Result<Model> load_model(const RobotChoice& choice) {
  return find_model_file(choice.robot).and_then([&](const std::filesystem::path& file) {
    return Model::load(file, load_options(choice));
  });
}

void tell_warnings(const Model& model) {
  for (const std::string& warning : model.warnings()) log_info(warning);
}

Result<Robot> load_robot(const RobotChoice& options) {
  if (options.robot.empty()) {
    return fail(Errc::usage, text(msg::app_option_missing, "--robot"));
  }
  Result<Robot> robot =
      mjarm::load_robot(options.robot, {.tip = options.tip, .load = load_options(options)});
  if (!robot) return robot;
  for (const std::string& warning : robot->model.warnings()) log_debug(warning);
  return robot;
}

}  // namespace mjarm::app
