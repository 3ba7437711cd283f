#include "apps/mjarm/messages/demo.hpp"

#include <array>
#include <cstdio>
#include <memory>
#include <utility>
#include <variant>
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
  std::string out, seconds, text, control, robot, tip;
  std::vector<std::string> package_paths;
  bool headless = false, meshes = false, guide = false, video = false, no_timing = false,
       allow_outside = false;
  Replace replace;
};

/// One option of demos, and which demos take it.
struct DemoOption {
  using Value = std::variant<std::string DemoArguments::*, bool DemoArguments::*,
                             std::vector<std::string> DemoArguments::*>;
  const char* name;
  unsigned use;  ///< of DemoUse; 0: all of them
  Value value;
  Msg help;
  const char* type;
};

const std::array<DemoOption, 13>& demo_options() {
  using A = DemoArguments;
  static const std::array<DemoOption, 13> kOptions = {
      {{"--out", 0, &A::out, msg::demo_option_out, "DIR"},
       {"--headless", 0, &A::headless, msg::demo_option_headless, ""},
       {"--video", 0, &A::video, msg::demo_option_video, ""},
       {"--no-timing", 0, &A::no_timing, msg::demo_option_no_timing, ""},
       {"--robot", kUseRobot, &A::robot, msg::app_option_robot, "ROBOT"},
       {"--tip", kUseRobot, &A::tip, msg::app_option_tip, "FRAME"},
       {"--package-path", kUseFiles, &A::package_paths, msg::app_option_package_path, "DIR"},
       {"--allow-outside", kUseFiles, &A::allow_outside, msg::app_option_outside, ""},
       {"--meshes", kUseMeshes, &A::meshes, msg::models_option_meshes, ""},
       {"--seconds", kUseSeconds, &A::seconds, msg::demo_option_seconds, "S"},
       {"--control", kUseControl, &A::control, msg::demo_option_control, "MODE"},
       {"--guide", kUseGuide, &A::guide, msg::demo_option_guide, ""},
       {"--text", kUseText, &A::text, msg::demo_option_text, "TEXT"}}};
  return kOptions;
}

bool takes(const Demo& demo, const DemoOption& option) {
  return option.use == 0 || (demo.uses & option.use) != 0;
}

void add(CLI::App& app, const DemoOption& option, DemoArguments& arguments) {
  if (const auto* flag = std::get_if<bool DemoArguments::*>(&option.value)) {
    add_flag(app, option.name, arguments.*(*flag), option.help);
  } else if (const auto* word = std::get_if<std::string DemoArguments::*>(&option.value)) {
    add_option(app, option.name, arguments.*(*word), option.help, option.type);
  } else {
    add_option(app, option.name, arguments.*std::get<2>(option.value), option.help, option.type);
  }
}

bool is_given(const DemoOption& option, const DemoArguments& arguments) {
  if (const auto* flag = std::get_if<bool DemoArguments::*>(&option.value)) {
    return arguments.*(*flag);
  }
  if (const auto* word = std::get_if<std::string DemoArguments::*>(&option.value)) {
    return !(arguments.*(*word)).empty();
  }
  return !(arguments.*std::get<2>(option.value)).empty();
}

/// An option that would do nothing is a mistake.
Result<void> check_use(const Demo& demo, const DemoArguments& arguments) {
  std::vector<std::string> taken;
  for (const DemoOption& option : demo_options()) {
    if (takes(demo, option)) taken.emplace_back(option.name);
  }
  for (const DemoOption& option : demo_options()) {
    if (takes(demo, option) || !is_given(option, arguments)) continue;
    return fail(Errc::usage, text(msg::demo_not_used, demo.name, option.name, listed(taken)));
  }
  return {};
}

void list_demos() {
  for (const Demo& demo : demos()) {
    std::printf("%-12s  %s\n", demo.name, text(demo.summary).c_str());
  }
}

Result<DemoOptions> read_options(const Demo& demo, const DemoArguments& arguments) {
  DemoOptions options;
  options.robot = {.robot = arguments.robot.empty() ? "ur5e" : arguments.robot,
                   .tip = arguments.tip,
                   .package_paths = arguments.package_paths,
                   .allow_outside = arguments.allow_outside};
  options.out = arguments.out.empty() ? std::filesystem::path("mjarm-out") / demo.name
                                      : std::filesystem::path(arguments.out);
  options.headless = arguments.headless;
  options.meshes = arguments.meshes;
  options.guide = arguments.guide;
  options.video = arguments.video;
  options.timing = !arguments.no_timing;
  options.replace = arguments.replace;
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

Result<int> run_demo(const Demo& demo, const DemoArguments& arguments) {
  if (Result<void> used = check_use(demo, arguments); !used) return fail(used.error());
  const Result<DemoOptions> options = read_options(demo, arguments);
  if (!options) return fail(options.error());
  catch_interrupts();
  const Result<Report> report =
      view::beside_windows(options->headless, [&] { return demo.run(*options); });
  if (!report) return fail(report.error());
  return conclude(*report, options->out);
}

/// Each demo is a command with the options it takes, so that its help shows these; the options may
/// stand before the name as well.
Run setup(CLI::App& app) {
  auto arguments = std::make_shared<DemoArguments>();
  for (const DemoOption& option : demo_options()) add(app, option, *arguments);
  add_overwrite_option(app, arguments->replace);
  std::vector<std::pair<const CLI::App*, const Demo*>> commands;
  for (const Demo& demo : demos()) {
    CLI::App& sub = add_subcommand(app, demo.name, demo.summary, {demo.examples, demo.examples});
    for (const DemoOption& option : demo_options()) {
      if (takes(demo, option)) add(sub, option, *arguments);
    }
    add_overwrite_option(sub, arguments->replace);
    commands.emplace_back(&sub, &demo);
  }
  return [arguments, commands]() -> Result<int> {
    for (const auto& [command, demo] : commands) {
      if (is_called(*command)) return run_demo(*demo, *arguments);
    }
    list_demos();
    return 0;
  };
}

}  // namespace

std::span<const Demo> demos() {
  constexpr unsigned kArm = kUseRobot | kUseFiles | kUseMeshes | kUseSeconds;
  constexpr unsigned kDriven = kArm | kUseControl;
  constexpr unsigned kGuided = kDriven | kUseGuide;
  static constexpr Demo kDemos[] = {
      {"car", msg::demo_about_car, run_car, kUseMeshes | kUseSeconds,
       "  mjarm demo car --headless"},
      {"ur5e", msg::demo_about_ur5e, run_ur5e, kDriven,
       "  mjarm demo ur5e --control servo_gravity"},
      {"ur5e_vision", msg::demo_about_ur5e_vision, run_ur5e_vision, kDriven,
       "  mjarm demo ur5e_vision --seconds 2"},
      {"point", msg::demo_about_point, run_point, kArm, "  mjarm demo point --headless"},
      {"movej", msg::demo_about_movej, run_movej, kGuided, "  mjarm demo movej --guide"},
      {"movel", msg::demo_about_movel, run_movel, kGuided, "  mjarm demo movel --control servo"},
      {"ellipse", msg::demo_about_ellipse, run_ellipse, kGuided,
       "  mjarm demo ellipse --headless --video"},
      {"letters", msg::demo_about_letters, run_letters, kDriven | kUseText,
       "  mjarm demo letters --text HELLO"},
      {"singularity", msg::demo_about_singularity, run_singularity, kDriven,
       "  mjarm demo singularity --headless"},
      {"flip", msg::demo_about_flip, run_flip, kDriven, "  mjarm demo flip --headless"},
      {"avoid", msg::demo_about_avoid, run_avoid, kUseRobot | kUseSeconds | kUseControl,
       "  mjarm demo avoid --tip ee_link"},
      {"square", msg::demo_about_square, run_square, kDriven,
       "  mjarm demo square --robot my_arm.urdf"},
      {"reach", msg::train_about_reach, run_reach, 0, "  mjarm demo reach --headless"},
  };
  return kDemos;
}

Command demo_command() { return {"demo", msg::demo_summary, msg::demo_examples, setup}; }

}  // namespace mjarm::app
