#include "mjarm/identification/identify.hpp"

#include <memory>
#include <optional>
#include <string>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/commands/identify_output.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/identify.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot{.looks = false};
  std::string log, empty;
  bool links = false, json = false;
};

/// A warning where the estimates explain too little.
void tell_poor(const Identification& found, const Arm& arm) {
  constexpr double kPoor = 0.02;  // of the torque limit
  Eigen::Index worst = 0;
  JointVec share(arm.dof());
  for (int j = 0; j < arm.dof(); ++j) {
    share[j] = found.joints[static_cast<std::size_t>(j)].rms / arm.limits.torque[j];
  }
  if (share.maxCoeff(&worst) < kPoor) return;
  log_warning(text(msg::identify_poor, 100 * share[worst],
                   arm.joints[static_cast<std::size_t>(worst)].name));
}

Result<int> run(const Options& options) {
  if (options.log.empty()) return fail(Errc::usage, text(msg::identify_which));
  if (options.links && !options.empty.empty()) return fail(Errc::usage, text(msg::identify_both));
  catch_interrupts();
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  const Result<JointLog> log = read_joint_log(options.log, robot->arm);
  if (!log) return fail(log.error());
  std::optional<JointLog> empty;
  if (!options.empty.empty()) {
    Result<JointLog> read = read_joint_log(options.empty, robot->arm);
    if (!read) return fail(read.error());
    empty = std::move(*read);
  }
  const Result<Identification> found = identify(*robot, {.log = &*log,
                                                         .empty = empty ? &*empty : nullptr,
                                                         .payload = !options.links,
                                                         .links = options.links,
                                                         .stop = interrupted});
  if (!found) return fail(found.error());
  tell_poor(*found, robot->arm);
  print_lines(options.json ? identification_json(*found, robot->arm)
                           : identification_text(*found, robot->arm));
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "log", options->log, msg::identify_file, "LOG.csv");
  add_robot_options(app, options->robot);
  add_option(app, "--empty", options->empty, msg::identify_option_empty, "EMPTY.csv");
  add_flag(app, "--links", options->links, msg::identify_option_links);
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command identify_command() {
  return {"identify", msg::identify_summary, msg::identify_examples, setup};
}

}  // namespace mjarm::app
