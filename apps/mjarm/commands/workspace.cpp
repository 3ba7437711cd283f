#include "mjarm/kinematics/workspace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/orientation.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/workspace_output.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/workspace.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::app {
namespace {

/// [m] heights of the slice where none is asked for: the first at which the tool reaches anything.
constexpr std::array kHeights{0.4, 0.3, 0.2, 0.1, 0.0};

struct Options {
  RobotChoice robot{.looks = false};
  std::string slice, step = "20mm", euler, quat, out, threads = "1";
  Replace replace;
  bool tool_down = false, position_only = false, json = false;
};

/// Reads `z=0.4` or `x=-10cm`.
Result<void> read_slice(const std::string& words, WorkspaceOptions& work) {
  const std::string_view view = words;
  if (view.size() < 3 || view[0] < 'x' || view[0] > 'z' || view[1] != '=') {
    return fail(Errc::usage, text(msg::workspace_bad_slice, words));
  }
  const Result<double> at = parse_quantity(view.substr(2), Quantity::length);
  if (!at) return fail(in_option("--slice", at.error()));
  work.normal = view[0] - 'x';
  work.at = *at;
  return {};
}

/// How the tool is to stand; none where any way will do.
Result<std::optional<Eigen::Matrix3d>> read_rotation(const Options& options, const Arm& arm) {
  const int given = (options.tool_down ? 1 : 0) + (options.position_only ? 1 : 0) +
                    (options.euler.empty() ? 0 : 1) + (options.quat.empty() ? 0 : 1);
  if (given > 1) return fail(Errc::usage, text(msg::workspace_one_orientation));
  if (!options.euler.empty() || !options.quat.empty()) {
    const Result<Eigen::Matrix3d> R = parse_rotation(options.euler, options.quat);
    if (!R) return fail(R.error());
    return *R;
  }
  if (options.position_only || (given == 0 && task_for(arm) == IkTask::position))
    return std::nullopt;
  return from_euler({std::numbers::pi, 0, 0});
}

Result<WorkspaceOptions> read_work(const Options& options, const Arm& arm) {
  WorkspaceOptions work;
  if (!options.slice.empty()) {
    if (Result<void> fine = read_slice(options.slice, work); !fine) return fail(fine.error());
  }
  const Result<double> step = parse_quantity(options.step, Quantity::length);
  if (!step) return fail(in_option("--step", step.error()));
  work.step = *step;
  const Result<std::uint64_t> threads = parse_whole("--threads", options.threads);
  if (!threads) return fail(threads.error());
  constexpr std::uint64_t kMax = 1024;
  if (*threads > kMax) {
    return fail(Errc::usage, text(msg::workspace_count, "--threads", 0, kMax, *threads));
  }
  work.threads = *threads == 0 ? core_count() : static_cast<int>(*threads);
  const auto R = read_rotation(options, arm);
  if (!R) return fail(R.error());
  work.R_WT = *R;
  return work;
}

/// @param any_height  the slice is the first of kHeights that is not empty; `work` says which.
Result<WorkspaceMap> make_map(const Arm& arm, WorkspaceOptions& work, bool any_height) {
  Progress progress(text(msg::workspace_progress), 0);
  work.progress = [&progress](std::size_t cells) { progress.advance(cells); };
  work.stop = interrupted;
  if (!any_height) return map_workspace(arm, work);
  Result<WorkspaceMap> map;
  for (const double height : kHeights) {
    work.at = height;
    map = map_workspace(arm, work);
    if (map || map.error().code != Errc::impossible) break;
  }
  return map;
}

Result<int> run(const Options& options) {
  const Result<WorkspaceFormat> format = workspace_format(options.out);
  if (!format) return fail(format.error());
  const Result<LongResult> result = LongResult::begin(options.out, options.replace);
  if (!result) return fail(result.error());
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  Result<WorkspaceOptions> work = read_work(options, robot->arm);
  if (!work) return fail(work.error());
  const Result<WorkspaceMap> map = make_map(robot->arm, *work, options.slice.empty());
  if (!map) return fail(map.error());
  const WorkspaceReport report{robot->arm, *work, *map};
  if (Result<void> written = write_workspace(report, options.out, *format); !written) {
    return fail(written.error());
  }
  result->made();
  const std::string out = options.json ? workspace_json(report) : workspace_summary(report) + '\n';
  std::fwrite(out.data(), 1, out.size(), stdout);
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_robot_options(app, options->robot);
  add_option(app, "--slice", options->slice, msg::workspace_option_slice, "z=0.4");
  add_option(app, "--step", options->step, msg::workspace_option_step, "LENGTH");
  add_flag(app, "--tool-down", options->tool_down, msg::workspace_option_tool_down);
  add_option(app, "--euler", options->euler, msg::app_option_euler, "A,B,C");
  add_option(app, "--quat", options->quat, msg::app_option_quat, "W,X,Y,Z");
  add_flag(app, "--position-only", options->position_only, msg::workspace_option_position);
  add_option(app, "--out", options->out, msg::workspace_option_out, "F.png|svg|csv|json");
  add_overwrite_option(app, options->replace);
  add_option(app, "--threads", options->threads, msg::workspace_option_threads, "N");
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command workspace_command() {
  return {"workspace", msg::workspace_summary, msg::workspace_examples, setup};
}

}  // namespace mjarm::app
