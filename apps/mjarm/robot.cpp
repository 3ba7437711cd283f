#include "apps/mjarm/robot.hpp"

#include <utility>

#include "apps/mjarm/options.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/app.hpp"

namespace mjarm::app {

void add_outside_option(CLI::App& app, bool& allowed) {
  add_flag(app, "--allow-outside", allowed, msg::app_option_outside);
}

void add_robot_options(CLI::App& app, RobotOptions& options) {
  add_option(app, "--robot", options.robot, msg::app_option_robot, "ROBOT");
  add_option(app, "--tip", options.tip, msg::app_option_tip, "FRAME");
  add_package_path_option(app, options.package_paths);
  add_outside_option(app, options.allow_outside);
}

void add_package_path_option(CLI::App& app, std::vector<std::string>& folders) {
  add_option(app, "--package-path", folders, msg::app_option_package_path, "DIR");
}

Result<Model> load_model(const RobotOptions& options) {
  const Result<std::filesystem::path> file = find_model_file(options.robot);
  if (!file) return fail(file.error());
  return Model::load(*file,
                     {.package_paths = {options.package_paths.begin(), options.package_paths.end()},
                      .allow_outside = options.allow_outside});
}

void tell_warnings(const Model& model) {
  for (const std::string& warning : model.warnings()) log_info(warning);
}

Result<Robot> load_robot(const RobotOptions& options) {
  if (options.robot.empty()) {
    return fail(Errc::usage, text(msg::app_option_missing, "--robot"));
  }
  Result<Model> model = load_model(options);
  if (!model) return fail(std::move(model.error()));
  for (const std::string& warning : model->warnings()) log_debug(warning);
  Result<Arm> arm = find_arm(*model, {.tip = options.tip});
  if (!arm) return fail(std::move(arm.error()));
  return Robot{std::move(*model), std::move(*arm)};
}

}  // namespace mjarm::app
