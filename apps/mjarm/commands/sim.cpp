#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/render_options.hpp"
#include "apps/mjarm/commands/sim_options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "apps/mjarm/messages/render_command.hpp"
#include "apps/mjarm/messages/sim_command.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/text_width.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/floating_base.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/model_run_output.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot;
  SimArguments sim;
  std::string seconds = "5", out = "mjarm-out/sim", camera;
  bool video = false, no_timing = false;
  Replace replace;
};

/// From where to where the parts went that moved most.
void print_travel(const Model& model, const session::ModelRunReport& report) {
  constexpr std::size_t kMaxLines = 12;
  const std::vector<StateColumn> columns = state_columns(model).qpos;
  std::vector<std::size_t> shown(columns.size());
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = i;
  const auto travel = [&](std::size_t i) {
    return std::abs(report.qpos_end[i] - report.qpos_start[i]);
  };
  std::ranges::stable_sort(shown, std::greater<>(), travel);
  shown.resize(std::min(shown.size(), kMaxLines));
  std::ranges::sort(shown);
  int width = 0;
  for (const std::size_t i : shown) width = std::max(width, text_width(columns[i].name));
  for (const std::size_t i : shown) {
    std::printf("%s %12.6g -> %12.6g %s\n", padded(columns[i].name, width).c_str(),
                report.qpos_start[i], report.qpos_end[i], columns[i].unit.c_str());
  }
}

/// What will surprise whoever simulates it.
void tell_oddities(const Model& model, const std::string& file) {
  if (model.nq() == 0) log_warning(text(msg::sim_command_nothing_moves, file));
  const Result<Arm> arm = find_arm(model);
  const auto base = arm ? floating_base(model, *arm) : std::nullopt;
  if (base) log_warning(text(msg::sim_command_base_floats, *base));
}

int conclude(const Model& model, const session::ModelRunReport& report, const std::string& out) {
  if (!report.ok) log_error(report.detail);
  log_info(text(msg::sim_command_done, report.duration, report.steps));
  if (report.rtf) log_info(text(msg::demo_rtf, report.duration, *report.rtf));
  print_travel(model, report);
  std::printf("%s\n", text(msg::demo_folder, out).c_str());
  return report.ok ? 0 : 1;
}

Result<int> run(const Options& options) {
  const std::string& file = options.robot.robot;
  if (file.empty()) return fail(Errc::usage, text(msg::sim_command_which));
  if (program::is_program(file)) return fail(Errc::usage, text(msg::sim_command_program, file));
  const Result<double> seconds = parse_quantity(options.seconds, Quantity::time);
  if (!seconds) return fail(in_option("--seconds", seconds.error()));
  const Result<Model> model = load_model(options.robot);
  if (!model) return fail(model.error());
  tell_warnings(*model);
  const auto how = read_sim_options(*model, options.sim, *seconds);
  if (!how) return fail(how.error());
  const Result<render::Camera> camera = choose_camera(*model, options.camera);
  if (!camera) return fail(camera.error());
  tell_oddities(*model, file);
  const session::ModelOutput output{.out = options.out,
                                    .camera = *camera,
                                    .video = options.video,
                                    .timing = !options.no_timing,
                                    .replace = options.replace};
  const auto report = session::simulate_model(*model, *how, output);
  if (!report) return fail(report.error());
  return conclude(*model, *report, options.out);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "file", options->robot.robot, msg::sim_command_file, "FILE");
  add_option(app, "--seconds", options->seconds, msg::sim_command_option_seconds, "S");
  add_sim_options(app, options->sim);
  add_option(app, "--out", options->out, msg::sim_command_option_out, "DIR");
  add_flag(app, "--video", options->video, msg::demo_option_video);
  add_option(app, "--camera", options->camera, msg::render_command_option_camera, "C");
  add_flag(app, "--no-timing", options->no_timing, msg::demo_option_no_timing);
  add_overwrite_option(app, options->replace);
  add_package_path_option(app, options->robot.package_paths);
  add_outside_option(app, options->robot.allow_outside);
  return [options] { return run(*options); };
}

}  // namespace

Command sim_command() {
  return {"sim", msg::sim_command_summary, msg::sim_command_examples, setup};
}

}  // namespace mjarm::app
