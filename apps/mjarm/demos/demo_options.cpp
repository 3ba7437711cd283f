#include "apps/mjarm/demos/demo_options.hpp"

#include <array>
#include <optional>
#include <utility>
#include <variant>

#include "apps/mjarm/cli/orientation.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "apps/mjarm/messages/demo_values.hpp"
#include "apps/mjarm/messages/models.hpp"
#include "apps/mjarm/messages/plan.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm::app {
namespace {

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

std::span<const DemoOption> demo_options() {
  using A = DemoArguments;
  static const DemoOption kOptions[] = {
      {"--out", 0, &A::out, msg::demo_option_out, "DIR"},
      {"--headless", 0, &A::headless, msg::demo_option_headless, ""},
      {"--video", 0, &A::video, msg::demo_option_video, ""},
      {"--no-timing", 0, &A::no_timing, msg::demo_option_no_timing, ""},
      {"--robot", kUseRobot, &A::robot, msg::app_option_robot, "ROBOT"},
      {"--tip", kUseRobot, &A::tip, msg::app_option_tip, "FRAME"},
      {"--package-path", kUseFiles, &A::package_paths, msg::app_option_package_path, "DIR"},
      {"--allow-outside", kUseFiles, &A::allow_outside, msg::app_option_outside, ""},
      {"--allow", kUseAllow, &A::allow, msg::plan_option_allow, "A,B"},
      {"--meshes", kUseMeshes, &A::meshes, msg::models_option_meshes, ""},
      {"--seconds", kUseSeconds, &A::seconds, msg::demo_option_seconds, "S"},
      {"--control", kUseControl, &A::control, msg::demo_option_control, "MODE"},
      {"--guide", kUseGuide, &A::guide, msg::demo_option_guide, ""},
      {"--pos", kUsePos, &A::pos, msg::demo_values_to, "X,Y,Z"},
      {"--to", kUseTo, &A::to, msg::demo_values_to, "X,Y,Z"},
      {"--from", kUseFrom, &A::from, msg::demo_values_from, "X,Y,Z"},
      {"--joints", kUseJoints, &A::joints, msg::demo_values_joints, "Q"},
      {"--ctrl", kUseCtrl, &A::ctrl, msg::demo_values_ctrl, "Q"},
      {"--start", kUseCtrl, &A::start, msg::demo_values_start, "Q"},
      {"--text", kUseText, &A::text, msg::demo_option_text, "TEXT"},
      {"--height", kUseText, &A::height, msg::demo_values_height, "LENGTH"},
      {"--center", kUsePlane, &A::center, msg::demo_values_center, "X,Y,Z"},
      {"--a", kUseAxes, &A::a, msg::demo_values_a, "LENGTH"},
      {"--b", kUseAxes, &A::b, msg::demo_values_b, "LENGTH"},
      {"--radius", kUseAxes, &A::radius, msg::demo_values_radius, "LENGTH"},
      {"--normal", kUsePlane, &A::normal, msg::demo_values_normal, "X,Y,Z"},
      {"--euler", kUseOrientation, &A::euler, msg::demo_values_euler, "X,Y,Z"},
      {"--quat", kUseOrientation, &A::quat, msg::demo_values_quat, "W,X,Y,Z"},
      {"--seed-q", kUseSeed, &A::seed_q, msg::demo_values_seed, "Q"},
      {"--seed", kUseDraw, &A::seed, msg::demo_option_seed, "N"}};
  return kOptions;
}

bool is_taken(unsigned uses, const DemoOption& option) {
  return option.use == 0 || (uses & option.use) != 0;
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
    if (is_taken(demo.uses, option)) taken.emplace_back(option.name);
  }
  for (const DemoOption& option : demo_options()) {
    if (is_taken(demo.uses, option) || !is_given(option, arguments)) continue;
    return fail(Errc::usage, text(msg::demo_not_used, demo.name, option.name, listed(taken)));
  }
  return {};
}

/// Of each of these pairs one would have no effect beside the other.
Result<void> check_together(const DemoArguments& arguments) {
  using A = DemoArguments;
  static constexpr std::pair<std::string A::*, std::string A::*> kPairs[] = {
      {&A::joints, &A::to}, {&A::joints, &A::euler}, {&A::joints, &A::quat},
      {&A::radius, &A::a},  {&A::radius, &A::b},     {&A::euler, &A::quat}};
  const auto name_of = [](std::string A::* member) {
    for (const DemoOption& option : demo_options()) {
      const auto* word = std::get_if<std::string A::*>(&option.value);
      if (word != nullptr && *word == member) return option.name;
    }
    return "";
  };
  for (const auto& [first, second] : kPairs) {
    if ((arguments.*first).empty() || (arguments.*second).empty()) continue;
    return fail(Errc::usage, text(msg::app_exclusive_options, name_of(first), name_of(second)));
  }
  if (arguments.guide && !arguments.joints.empty()) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--guide", "--joints"));
  }
  if (arguments.guide && !arguments.center.empty()) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--guide", "--center"));
  }
  return {};
}

/// A value that is only read where it is given.
Result<void> read_vector(const char* option, const std::string& words, Quantity quantity,
                         std::optional<Eigen::Vector3d>& out) {
  if (words.empty()) return {};
  const auto values = parse_list(option, words, quantity, 3);
  if (!values) return fail(values.error());
  out = Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]);
  return {};
}

Result<void> read_size(const char* option, const std::string& words, std::optional<double>& out) {
  if (words.empty()) return {};
  const Result<double> value = parse_quantity(words, Quantity::length);
  if (!value) return fail(in_option(option, value.error()));
  if (!(*value > 0)) return fail(Errc::bad_input, text(msg::demo_values_size, option, words));
  out = *value;
  return {};
}

Result<DemoValues> read_values(const DemoArguments& arguments) {
  DemoValues values{.to = {},
                    .from = {},
                    .R = {},
                    .center = {},
                    .normal = {},
                    .a = {},
                    .b = {},
                    .height = {},
                    .text = arguments.text,
                    .seed = 1,
                    .seed_q = arguments.seed_q,
                    .start = arguments.start,
                    .joints = arguments.joints,
                    .ctrl = arguments.ctrl};
  const Quantity length = Quantity::length;
  Result<void> read =
      read_vector("--pos", arguments.pos, length, values.to)
          .and_then([&] { return read_vector("--to", arguments.to, length, values.to); })
          .and_then([&] { return read_vector("--from", arguments.from, length, values.from); })
          .and_then(
              [&] { return read_vector("--center", arguments.center, length, values.center); })
          .and_then([&] {
            return read_vector("--normal", arguments.normal, Quantity::number, values.normal);
          })
          .and_then([&] { return read_size("--height", arguments.height, values.height); })
          .and_then([&] { return read_size("--a", arguments.a, values.a); })
          .and_then([&] { return read_size("--b", arguments.b, values.b); })
          .and_then([&] { return read_size("--radius", arguments.radius, values.a); });
  if (!read) return fail(std::move(read.error()));
  if (!arguments.seed.empty()) {
    const Result<std::uint64_t> seed = parse_whole("--seed", arguments.seed);
    if (!seed) return fail(seed.error());
    values.seed = *seed;
  }
  if (!arguments.radius.empty()) values.b = values.a;
  if (values.normal && !(values.normal->norm() > 1e-9)) {
    return fail(Errc::bad_input, text(msg::demo_values_zero, arguments.normal));
  }
  if (arguments.euler.empty() && arguments.quat.empty()) return values;
  const Result<Eigen::Matrix3d> R = parse_rotation(arguments.euler, arguments.quat);
  if (!R) return fail(R.error());
  values.R = *R;
  return values;
}

/// The tutorial's way is another run, so that both can be compared.
std::filesystem::path default_folder(const Demo& demo, const DemoArguments& arguments) {
  return std::filesystem::path("mjarm-out") /
         (demo.name + std::string(arguments.guide ? "-guide" : ""));
}

}  // namespace

void add_demo_options(CLI::App& app, unsigned uses, DemoArguments& arguments) {
  for (const DemoOption& option : demo_options()) {
    if (!is_taken(uses, option)) continue;
    if (const auto* flag = std::get_if<bool DemoArguments::*>(&option.value)) {
      add_flag(app, option.name, arguments.*(*flag), option.help);
    } else if (const auto* word = std::get_if<std::string DemoArguments::*>(&option.value)) {
      add_option(app, option.name, arguments.*(*word), option.help, option.type);
    } else {
      add_option(app, option.name, arguments.*std::get<2>(option.value), option.help, option.type);
    }
  }
  add_run_page_options(app, arguments.pages);
  add_overwrite_option(app, arguments.replace);
}

Result<DemoOptions> read_demo_options(const Demo& demo, const DemoArguments& arguments) {
  if (Result<void> used = check_use(demo, arguments); !used) return fail(used.error());
  if (Result<void> fits = check_together(arguments); !fits) return fail(fits.error());
  DemoOptions options;
  options.robot = {.robot = arguments.robot.empty() ? "ur5e" : arguments.robot,
                   .tip = arguments.tip,
                   .package_paths = arguments.package_paths,
                   .allow_outside = arguments.allow_outside};
  options.out = arguments.out.empty() ? default_folder(demo, arguments)
                                      : std::filesystem::path(arguments.out);
  options.headless = arguments.headless;
  options.meshes = arguments.meshes;
  options.guide = arguments.guide;
  options.video = arguments.video;
  options.timing = !arguments.no_timing;
  options.replace = arguments.replace;
  options.allow = arguments.allow;
  Result<DemoValues> values = read_values(arguments);
  if (!values) return fail(std::move(values.error()));
  options.values = std::move(*values);
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

}  // namespace mjarm::app
