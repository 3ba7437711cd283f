#include "apps/mjarm/messages/demo.hpp"

#include <cstdio>
#include <memory>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/commands/run_output.hpp"
#include "apps/mjarm/demos/demos.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/models.hpp"
#include "apps/mjarm/messages/train.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/view/remote_window.hpp"

namespace mjarm::app {
namespace {

/// Options as the user wrote them.
struct DemoArguments {
  std::string name, out, seconds, text, control;
  RobotChoice robot{.robot = "ur5e"};
  bool headless = false, meshes = false, guide = false, video = false, no_timing = false;
};

void list_demos() {
  for (const Demo& demo : demos()) {
    std::printf("%-12s  %s\n", demo.name, text(demo.summary).c_str());
  }
}

Result<const Demo*> find_demo(const std::string& name) {
  std::vector<std::string> names;
  for (const Demo& demo : demos()) {
    if (name == demo.name) return &demo;
    names.emplace_back(demo.name);
  }
  return fail(Errc::usage, text(msg::demo_unknown, name) + did_you_mean(name, names));
}

Result<DemoOptions> read_options(const DemoArguments& arguments) {
  DemoOptions options;
  options.robot = arguments.robot;
  options.out = arguments.out.empty() ? std::filesystem::path("mjarm-out") / arguments.name
                                      : std::filesystem::path(arguments.out);
  options.headless = arguments.headless;
  options.meshes = arguments.meshes;
  options.guide = arguments.guide;
  options.video = arguments.video;
  options.timing = !arguments.no_timing;
  options.text = arguments.text;
  if (!arguments.seconds.empty()) {
    const Result<double> seconds = parse_quantity(arguments.seconds, Quantity::time);
    if (!seconds || !(*seconds > 0)) {
      return fail(Errc::usage, text(msg::demo_bad_seconds, arguments.seconds));
    }
    options.seconds = *seconds;
  }
  if (!arguments.control.empty()) {
    const Result<ControlMode> mode = control_mode(arguments.control);
    if (!mode) return fail(mode.error());
    options.control = *mode;
  }
  return options;
}

Result<int> run_demo(const DemoArguments& arguments) {
  if (arguments.name.empty()) {
    list_demos();
    return 0;
  }
  const Result<const Demo*> demo = find_demo(arguments.name);
  if (!demo) return fail(demo.error());
  const Result<DemoOptions> options = read_options(arguments);
  if (!options) return fail(options.error());
  catch_interrupts();
  const Result<Report> report =
      view::beside_windows(options->headless, [&] { return (*demo)->run(*options); });
  if (!report) return fail(report.error());
  return conclude(*report, options->out);
}

Run setup(CLI::App& app) {
  auto arguments = std::make_shared<DemoArguments>();
  add_option(app, "name", arguments->name, msg::demo_option_name, "NAME");
  add_option(app, "--out", arguments->out, msg::demo_option_out, "DIR");
  add_flag(app, "--headless", arguments->headless, msg::demo_option_headless);
  add_flag(app, "--meshes", arguments->meshes, msg::models_option_meshes);
  add_flag(app, "--guide", arguments->guide, msg::demo_option_guide);
  add_flag(app, "--video", arguments->video, msg::demo_option_video);
  add_option(app, "--seconds", arguments->seconds, msg::demo_option_seconds, "S");
  add_option(app, "--text", arguments->text, msg::demo_option_text, "TEXT");
  add_option(app, "--control", arguments->control, msg::demo_option_control, "MODE");
  add_robot_options(app, arguments->robot);
  add_flag(app, "--no-timing", arguments->no_timing, msg::demo_option_no_timing);
  return [arguments] { return run_demo(*arguments); };
}

}  // namespace

std::span<const Demo> demos() {
  static constexpr Demo kDemos[] = {
      {"car", msg::demo_about_car, run_car},
      {"ur5e", msg::demo_about_ur5e, run_ur5e},
      {"ur5e_vision", msg::demo_about_ur5e_vision, run_ur5e_vision},
      {"point", msg::demo_about_point, run_point},
      {"movej", msg::demo_about_movej, run_movej},
      {"movel", msg::demo_about_movel, run_movel},
      {"ellipse", msg::demo_about_ellipse, run_ellipse},
      {"letters", msg::demo_about_letters, run_letters},
      {"singularity", msg::demo_about_singularity, run_singularity},
      {"flip", msg::demo_about_flip, run_flip},
      {"avoid", msg::demo_about_avoid, run_avoid},
      {"square", msg::demo_about_square, run_square},
      {"reach", msg::train_about_reach, run_reach},
  };
  return kDemos;
}

Command demo_command() { return {"demo", msg::demo_summary, msg::demo_examples, setup}; }

}  // namespace mjarm::app
