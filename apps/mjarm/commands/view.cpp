#include "mjarm/core/messages/view.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/seen_robot.hpp"
#include "apps/mjarm/commands/window_options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/free_sim.hpp"
#include "mjarm/session/robot_session.hpp"
#include "mjarm/session/show_program.hpp"
#include "mjarm/session/simulate_world.hpp"
#include "mjarm/view/controls.hpp"
#include "mjarm/view/show_in_window.hpp"
#include "mjarm/view/target_handle.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot;
  WindowArguments window;
  std::string seconds, out;
  bool passive = false, paused = false, stats = false;
};

/// @param out  with what the user has no say in.
Result<view::WindowOptions> window_options(const Options& options, view::WindowOptions out) {
  out.paused = options.paused;
  out.screenshots = options.out;
  return read_window_options(options.window, std::move(out));
}

/// Tells how the window was drawn, where that was asked for.
Result<int> told(const Options& options, const Result<view::ViewStats>& stats) {
  if (!stats) return fail(stats.error());
  if (options.stats) {
    std::printf("%s\n", text(msg::view_stats, stats->frames, stats->fps, stats->frame_ms,
                             stats->first_frame_ms, stats->sim_rate)
                            .c_str());
  }
  return 0;
}

Result<int> run(const Options& options) {
  const Result<double> seconds = parse_show_seconds(options.seconds);
  if (!seconds) return fail(seconds.error());
  const Result<SeenRobot> loaded = load_seen_robot(options.robot, msg::view_which);
  if (!loaded) return fail(loaded.error());
  Result<session::FreeSim> sim = make_free_sim(*loaded, options.passive);
  if (!sim) return fail(std::move(sim.error()));
  Result<view::WindowOptions> chosen =
      window_options(options, {.can_target = sim->is_held(), .jog_dofs = sim->jog_dofs()});
  if (!chosen) return fail(chosen.error());
  if (auto set = set_camera(options.window.camera, loaded->model, *chosen); !set)
    return fail(set.error());
  catch_interrupts();
  if (options.paused) sim->handle(view::PauseEvent{true});
  session::RobotSession view(loaded->model, loaded->arm, *sim);
  std::optional<view::TargetHandle> handle;
  view::ShowOptions show{*seconds};
  if (session::TargetControl* target = view.target()) {
    handle.emplace(target->link(), target->target().turns());
    show.on_open = [&handle](view::Window& window) { handle->attach(window); };
  }
  return told(options,
              view::show_in_window(
                  loaded->model, "mjarm " + std::string(loaded->model.name()), *chosen, show,
                  [&view](view::ViewLink& link) { session::simulate_world(view, link); }));
}

Result<int> run_program(const Options& options) {
  const Result<double> seconds = parse_show_seconds(options.seconds);
  if (!seconds) return fail(seconds.error());
  Result<view::WindowOptions> window = window_options(options, {});
  if (!window) return fail(window.error());
  const Result<program::LoadedProgram> loaded = load_seen_program(options.robot, options.passive);
  if (!loaded) return fail(loaded.error());
  if (auto set = set_camera(options.window.camera, loaded->robot.model, *window); !set)
    return fail(set.error());
  return told(options, session::view_program(*loaded, *window, {*seconds}));
}

std::string view_help_end(Language language) {
  return examples_and_controls(language, msg::view_examples, msg::view_controls,
                               view::control_help);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "file", options->robot.robot, msg::view_file, "FILE");
  add_option(app, "--tip", options->robot.tip, msg::app_option_tip, "FRAME");
  add_load_options(app, options->robot);
  add_flag(app, "--passive", options->passive, msg::view_option_passive);
  add_flag(app, "--paused", options->paused, msg::view_option_paused);
  add_window_options(app, options->window);
  add_option(app, "--out", options->out, msg::view_option_out, "DIR");
  add_option(app, "--seconds", options->seconds, msg::view_option_seconds, "S");
  add_flag(app, "--stats", options->stats, msg::view_option_stats);
  return [options] {
    return program::is_program(options->robot.robot) ? run_program(*options) : run(*options);
  };
}

}  // namespace

Command view_command() {
  static const std::string english = view_help_end(Language::english);
  static const std::string chinese = view_help_end(Language::chinese);
  return {"view", msg::view_summary, Msg{english.c_str(), chinese.c_str()}, setup};
}

}  // namespace mjarm::app
