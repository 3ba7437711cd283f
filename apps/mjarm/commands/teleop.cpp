#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/page_options.hpp"
#include "apps/mjarm/commands/seen_robot.hpp"
#include "apps/mjarm/commands/window_options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "apps/mjarm/messages/teleop_command.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/episode/led_episode.hpp"
#include "mjarm/serve/show_in_page.hpp"
#include "mjarm/session/simulate_world.hpp"
#include "mjarm/session/teleop_run.hpp"
#include "mjarm/session/teleop_session.hpp"
#include "mjarm/view/show_in_window.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  RobotChoice robot;
  ServeArguments page;
  std::string frame = "world", speed = "0.25", turn = "1", margin = "5mm", fps = "20";
  std::string input, out, task, seconds;
  WindowArguments window;
  bool headless = false, no_guard = false, serve = false, json = false, no_timing = false;
  Replace replace;
};

/// What the options say, but for the robot.
struct Chosen {
  TeleopOptions teleop;
  TwistFrame frame = TwistFrame::world;
  int fps = 20;
  double seconds = 0;
};

Result<double> positive(const char* option, const std::string& value, Quantity quantity) {
  Result<double> number = parse_quantity(value, quantity);
  if (!number) return fail(in_option(option, number.error()));
  if (!(*number > 0)) return fail(Errc::usage, text(msg::teleop_command_above_zero, option, value));
  return number;
}

Result<Chosen> choose(const Options& options) {
  Chosen out;
  const std::string frames[] = {"world", "tool"};
  const auto frame = parse_choice("--frame", options.frame, frames);
  if (!frame) return fail(frame.error());
  out.frame = *frame == 0 ? TwistFrame::world : TwistFrame::tool;
  const Result<double> speed = positive("--speed", options.speed, Quantity::speed);
  if (!speed) return fail(speed.error());
  const Result<double> turn = positive("--turn", options.turn, Quantity::number);
  if (!turn) return fail(turn.error());
  const Result<double> margin = positive("--margin", options.margin, Quantity::length);
  if (!margin) return fail(margin.error());
  const Result<int> fps = parse_count("--fps", options.fps, 100);
  if (!fps) return fail(fps.error());
  const Result<double> seconds = parse_show_seconds(options.seconds);
  if (!seconds) return fail(seconds.error());
  out.teleop.speed = *speed;
  out.teleop.turn = *turn;
  out.teleop.watch.margin = *margin;
  out.teleop.guard = !options.no_guard;
  out.fps = *fps;
  out.seconds = *seconds;
  return out;
}

Result<void> check_together(const Options& options) {
  if (options.robot.robot.empty()) return fail(Errc::usage, text(msg::teleop_command_which));
  if (options.headless && options.input.empty()) {
    return fail(Errc::usage, text(msg::teleop_command_needs_input));
  }
  if (!options.headless && !options.input.empty()) {
    return fail(Errc::usage, text(msg::teleop_command_needs_headless));
  }
  if (options.headless && options.serve) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--headless", "--serve"));
  }
  if (!options.task.empty() && options.out.empty()) {
    return fail(Errc::usage, text(msg::teleop_command_needs_out));
  }
  return {};
}

Result<int> play(const Options& options, const Chosen& chosen, const Robot& robot) {
  const Result<std::vector<TimedInput>> inputs = read_inputs(options.input, chosen.frame);
  if (!inputs) return fail(inputs.error());
  const auto report = session::play_inputs(robot, *inputs,
                                           {.teleop = chosen.teleop,
                                            .out = options.out,
                                            .robot = options.robot.robot,
                                            .task = options.task,
                                            .fps = chosen.fps,
                                            .timing = !options.no_timing,
                                            .replace = options.replace,
                                            .stop = interrupted});
  if (!report) return fail(report.error());
  if (options.json) {
    print_lines(report->json(!options.no_timing).document());
  } else {
    std::string lines =
        text(msg::teleop_command_played, report->duration, report->way, report->slowed) + '\n';
    if (report->nearest) {
      lines += text(msg::teleop_command_nearest, report->nearest->body1, report->nearest->body2,
                    1e3 * report->nearest->distance) +
               '\n';
    }
    print_lines(lines);
  }
  if (report->stopped) {
    return fail(Errc::impossible, text(msg::teleop_command_stopped, report->duration));
  }
  if (!report->touched.empty()) {
    return fail(Errc::impossible, text(msg::teleop_command_touched, report->touched));
  }
  return 0;
}

Result<view::WindowOptions> window_options(const Options& options, const Model& model) {
  Result<view::WindowOptions> out =
      read_window_options(options.window, {.can_step = false,
                                           .can_push = false,
                                           .can_lead = true,
                                           .screenshots = options.out,
                                           .right_panel = true,
                                           .joints_open = false,
                                           .help = session::teleop_help()});
  if (!out) return out;
  if (auto set = set_camera(options.window.camera, model, *out); !set) return fail(set.error());
  return out;
}

Result<void> show(const Options& options, const Chosen& chosen, const Robot& robot,
                  const view::WindowOptions& window, session::TeleopSession& world) {
  const std::string title = "mjarm teleop " + std::string(robot.model.name());
  if (options.serve) {
    Result<serve::PageOptions> page = read_serve_options(options.page);
    if (!page) return fail(std::move(page.error()));
    page->seconds = chosen.seconds;
    return serve::show_in_page(robot.model, title, window, *page, [&world](view::ViewLink& link) {
      session::simulate_world(world, link, language());
    });
  }
  session::TeleopKeys keys(world.desk());
  session::TeleopGamepad gamepad(world.desk());
  const view::ShowOptions how{
      chosen.seconds, [&](view::Window& opened) {
        opened.set_key_hook([&](const view::KeyInput& input) { return keys.handle(input); });
        opened.set_gamepad_hook([&](const view::GamepadState* state) { gamepad.handle(state); });
      }};
  const auto shown = view::show_in_window(
      robot.model, title, window, how,
      [&world](view::ViewLink& link) { session::simulate_world(world, link); });
  if (!shown) return fail(shown.error());
  return {};
}

/// What an open session leaves behind, and what is told of it.
Result<int> conclude(const Options& options, const Chosen& chosen,
                     const session::TeleopSession& world) {
  if (!options.out.empty()) {
    const auto written =
        write_file(fs::path(options.out) / "inputs.csv", inputs_csv(world.inputs()));
    if (!written) return fail(written.error());
  }
  if (world.recorded() > 0) log_warning(text(msg::teleop_command_not_kept, world.recorded()));
  const session::TeleopLatency latency = world.latency();
  const double period = world.period();
  if (options.json) {
    print_lines(JsonDoc{{"frame", std::string(name(chosen.frame))},
                        {"period", period},
                        {"latency",
                         {{"count", latency.count},
                          {"mean", latency.mean},
                          {"p99", latency.p99},
                          {"max", latency.max}}}}
                    .document());
  } else if (latency.count > 0) {
    print_lines(text(msg::teleop_command_latency, latency.count, 1e3 * latency.mean,
                     1e3 * latency.p99, 1e3 * latency.max, 1e3 * period) +
                '\n');
  }
  return 0;
}

Result<int> lead(const Options& options, const Chosen& chosen, const Robot& robot) {
  const Result<view::WindowOptions> window = window_options(options, robot.model);
  if (!window) return fail(window.error());
  std::optional<OutputFolder> folder;
  session::TeleopSessionOptions how{
      .teleop = chosen.teleop, .frame = chosen.frame, .fps = chosen.fps, .keep = {}};
  if (!options.out.empty()) {
    Result<OutputFolder> opened = OutputFolder::open(options.out, options.replace);
    if (!opened) return fail(std::move(opened.error()));
    folder.emplace(std::move(*opened));
    how.keep = [&](const std::vector<episode::LedSample>& rows) -> Result<std::string> {
      const auto file = episode::keep_led_episode(
          options.out, robot, {options.robot.robot, options.task, chosen.fps}, rows);
      if (!file) return fail(file.error());
      return file->string();
    };
  }
  Result<session::TeleopSession> world = session::TeleopSession::create(robot, std::move(how));
  if (!world) return fail(std::move(world.error()));
  if (Result<session::SpaceMouse> mouse = session::SpaceMouse::open()) {
    world->set_space_mouse(std::move(*mouse));
  }
  if (auto shown = show(options, chosen, robot, *window, *world); !shown) {
    return fail(std::move(shown.error()));
  }
  return conclude(options, chosen, *world);
}

Result<int> run(const Options& options) {
  if (auto fits = check_together(options); !fits) return fail(std::move(fits.error()));
  const Result<Chosen> chosen = choose(options);
  if (!chosen) return fail(chosen.error());
  catch_interrupts();
  const Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(robot.error());
  tell_warnings(robot->model);
  return options.headless ? play(options, *chosen, *robot) : lead(options, *chosen, *robot);
}

std::string teleop_help_end(Language language) {
  return examples_and_controls(language, msg::teleop_command_examples, msg::teleop_command_keys,
                               session::teleop_help);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "file", options->robot.robot, msg::teleop_command_file, "ROBOT|SCENE");
  add_option(app, "--tip", options->robot.tip, msg::app_option_tip, "FRAME");
  add_load_options(app, options->robot);
  add_option(app, "--frame", options->frame, msg::teleop_command_frame, "world|tool");
  add_option(app, "--speed", options->speed, msg::teleop_command_speed, "M/S");
  add_option(app, "--turn", options->turn, msg::teleop_command_turn, "RAD/S");
  add_option(app, "--margin", options->margin, msg::teleop_command_margin, "M");
  add_flag(app, "--no-guard", options->no_guard, msg::teleop_command_no_guard);
  add_option(app, "--out", options->out, msg::teleop_command_out, "DIR");
  add_option(app, "--task", options->task, msg::teleop_command_task, "TEXT");
  add_option(app, "--fps", options->fps, msg::teleop_command_fps, "F");
  add_flag(app, "--headless", options->headless, msg::teleop_command_headless);
  add_option(app, "--input", options->input, msg::teleop_command_input, "FILE.csv");
  add_flag(app, "--serve", options->serve, msg::teleop_command_serve);
  add_serve_options(app, options->page);
  add_window_options(app, options->window);
  add_option(app, "--seconds", options->seconds, msg::view_option_seconds, "S");
  add_flag(app, "--json", options->json, msg::app_option_json);
  add_flag(app, "--no-timing", options->no_timing, msg::demo_option_no_timing);
  add_overwrite_option(app, options->replace);
  return [options] { return run(*options); };
}

}  // namespace

Command teleop_command() {
  static const std::string english = teleop_help_end(Language::english);
  static const std::string chinese = teleop_help_end(Language::chinese);
  return {"teleop", msg::teleop_command_summary, Msg{english.c_str(), chinese.c_str()}, setup};
}

}  // namespace mjarm::app
