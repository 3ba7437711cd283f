#include <cmath>
#include <filesystem>
#include <memory>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/page_options.hpp"
#include "apps/mjarm/commands/program_run.hpp"
#include "apps/mjarm/commands/run_output.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/demo.hpp"
#include "apps/mjarm/messages/motion_program.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string file, out, control, contact, tolerance, payload, max_duration = "3600";
  RobotChoice robot;  // that the program names: how its files are read
  bool headless = false, video = false, no_timing = false;
  RunPageArguments pages;
  Replace replace;
};

Result<session::StageOptions> stage_options(const Options& options) {
  session::StageOptions out;
  out.out = options.out;
  out.headless = options.headless;
  out.video = options.video;
  out.timing = !options.no_timing;
  out.replace = options.replace;
  if (options.control.empty()) return out;
  const Result<ControlMode> mode = control_mode(options.control);
  if (!mode) return fail(mode.error());
  out.control = *mode;
  return out;
}

Result<double> tolerance_of(const Options& options) {
  constexpr double kTolerance = 5e-4;  // [m]
  if (options.tolerance.empty()) return kTolerance;
  const Result<double> value = parse_quantity(options.tolerance, Quantity::length);
  if (!value) return fail(in_option("--tolerance", value.error()));
  if (!(*value > 0)) return fail(Errc::usage, text(msg::motion_program_tolerance, *value));
  return value;
}

Result<double> max_duration_of(const Options& options) {
  const Result<double> seconds = parse_quantity(options.max_duration, Quantity::time);
  if (!seconds) return fail(in_option("--max-duration", seconds.error()));
  if (!(*seconds > 0)) {
    return fail(Errc::usage, text(msg::motion_program_max_duration, options.max_duration));
  }
  return seconds;
}

/// Reads `1.2` or `1.2,0,0,50mm`.
Result<std::optional<Payload>> payload_of(const Options& options) {
  if (options.payload.empty()) return std::nullopt;
  const auto bad = [&] {
    return fail(Errc::usage, text(msg::motion_program_payload, options.payload));
  };
  const std::size_t comma = options.payload.find(',');
  const Result<double> mass = parse_quantity(options.payload.substr(0, comma), Quantity::number);
  constexpr double kMax = 1000;  // [kg]
  if (!mass || !(*mass >= 0 && *mass <= kMax)) return bad();
  if (comma == std::string::npos) return Payload{*mass};
  const Result<std::vector<double>> center =
      parse_quantities(options.payload.substr(comma + 1), Quantity::length);
  if (!center) return fail(in_option("--payload", center.error()));
  if (center->size() != 3) return bad();
  return Payload{*mass, Eigen::Vector3d(center->data())};
}

Result<std::optional<ContactReaction>> reaction_of(const Options& options) {
  if (options.contact.empty()) return std::optional<ContactReaction>();
  const Result<ContactReaction> reaction = contact_reaction(options.contact);
  if (!reaction) return fail(reaction.error());
  return std::optional(*reaction);
}

/// A program that cannot be done makes no folder; where there is one, a report of it takes the
/// place of that of an earlier run.
Result<int> refuse(const program::LoadedProgram& loaded, const session::StageOptions& options) {
  Error why = program::first_fault(loaded);
  std::error_code missing;
  if (why.code != Errc::impossible || !std::filesystem::exists(options.out, missing)) {
    return fail(std::move(why));
  }
  const Result<OutputFolder> folder = OutputFolder::open(options.out, options.replace);
  if (!folder) return fail(folder.error());
  session::remove_stale(options.out,
                        {"log.csv", "plot.png", "plot.svg", "picture.png", session::kVideoFile});
  Report report;
  report.name = loaded.program.name;
  report.model = loaded.robot.model.name();
  report.reason = loaded.plan.faults.front().reason;
  report.detail = why.what;
  if (Result<void> kept = write_file(options.out / "report.json", to_json(report)); !kept) {
    return fail(std::move(kept.error()));
  }
  return fail(std::move(why));
}

Result<int> run(const Options& options) {
  if (options.file.empty()) return fail(Errc::usage, text(msg::motion_program_which_run));
  const Result<double> tolerance = tolerance_of(options);
  if (!tolerance) return fail(tolerance.error());
  const Result<double> longest = max_duration_of(options);
  if (!longest) return fail(longest.error());
  Result<session::StageOptions> chosen = stage_options(options);
  if (!chosen) return fail(chosen.error());
  const Result<std::optional<Payload>> payload = payload_of(options);
  if (!payload) return fail(payload.error());
  const auto reaction = reaction_of(options);
  if (!reaction) return fail(reaction.error());
  const Result<RunPages> pages = read_run_pages(options.pages, options.headless);
  if (!pages) return fail(pages.error());
  chosen->record = pages->record;
  const Result<LongResult> free = LongResult::begin(chosen->out, chosen->replace);
  if (!free) return fail(free.error());  // before it is planned
  catch_interrupts();
  Result<program::LoadedProgram> loaded = program::load_program(
      options.file, interrupted, load_options(options.robot), session::see_scene, *payload);
  if (!loaded) return fail(loaded.error());
  if (chosen->out.empty()) chosen->out = std::filesystem::path("mjarm-out") / loaded->program.name;
  if (!loaded->plan.ok()) return refuse(*loaded, *chosen);
  const double duration = loaded->plan.duration();
  if (duration > *longest) {  // a slip of the pen, as a wait in milliseconds
    return fail(Errc::usage, text(msg::motion_program_too_long, options.file, duration, *longest,
                                  std::ceil(duration)));
  }
  if (chosen->control) loaded->program.control = chosen->control;
  if (*reaction) loaded->program.contact = *reaction;
  const Result<Report> report = beside_what_shows(
      *pages, chosen->headless, [&] { return run_and_show(*loaded, *chosen, *tolerance); });
  if (!report) return fail(report.error());
  return conclude(*report, chosen->out);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "program", options->file, msg::motion_program_file, "PROGRAM.yaml");
  add_option(app, "--out", options->out, msg::demo_option_out, "DIR");
  add_overwrite_option(app, options->replace);
  add_flag(app, "--headless", options->headless, msg::demo_option_headless);
  add_flag(app, "--video", options->video, msg::demo_option_video);
  add_run_page_options(app, options->pages);
  add_option(app, "--control", options->control, msg::demo_option_control, "MODE");
  add_option(app, "--payload", options->payload, msg::motion_program_option_payload, "KG[,X,Y,Z]");
  add_option(app, "--contact", options->contact, msg::motion_program_option_contact, "stop|ignore");
  add_option(app, "--tolerance", options->tolerance, msg::motion_program_option_tolerance,
             "LENGTH");
  add_option(app, "--max-duration", options->max_duration, msg::motion_program_option_max_duration,
             "S");
  add_flag(app, "--no-timing", options->no_timing, msg::demo_option_no_timing);
  add_load_options(app, options->robot);
  return [options] { return run(*options); };
}

}  // namespace

Command run_command() {
  return {"run", msg::motion_program_run_summary, msg::motion_program_run_examples, setup};
}

}  // namespace mjarm::app
