#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/motion_program.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/program/urscript.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string file, to, out;
  RobotChoice robot;  // that the program names: how its files are read
  Replace replace;
};

/// The format, the only one there is.
Result<void> check_format(const Options& options) {
  if (options.to.empty()) return fail(Errc::usage, text(msg::app_option_missing, "--to"));
  const std::string formats[] = {"urscript"};
  const Result<std::size_t> format = parse_choice("--to", options.to, formats);
  if (!format) return fail(format.error());
  return {};
}

Result<int> run(const Options& options) {
  if (options.file.empty()) return fail(Errc::usage, text(msg::motion_program_which_export));
  if (auto known = check_format(options); !known) return fail(known.error());
  std::error_code unknown;
  if (!options.out.empty() && std::filesystem::equivalent(options.out, options.file, unknown)) {
    return fail(Errc::usage, text(msg::motion_program_export_over, options.out));
  }
  const Result<LongResult> result = LongResult::begin(options.out, options.replace);
  if (!result) return fail(result.error());
  catch_interrupts();
  const Result<program::LoadedProgram> loaded = program::load_sound_program(
      options.file, interrupted, load_options(options.robot), session::see_scene);
  if (!loaded) return fail(loaded.error());
  const Result<std::string> script = program::to_urscript(loaded->program, loaded->robot,
                                                          loaded->plan, {.version = MJARM_VERSION});
  if (!script)
    return fail(script.error().code, text(msg::core_at_place, options.file, script.error().what));
  if (options.out.empty()) {
    std::fwrite(script->data(), 1, script->size(), stdout);
    return 0;
  }
  if (auto written = write_file(options.out, *script); !written) return fail(written.error());
  result->made();
  std::printf("%s\n", options.out.c_str());
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "program", options->file, msg::motion_program_file, "PROGRAM.yaml");
  add_option(app, "--to", options->to, msg::motion_program_option_to, "FORMAT");
  add_option(app, "--out", options->out, msg::motion_program_option_export_out, "FILE");
  add_load_options(app, options->robot);
  add_overwrite_option(app, options->replace);
  return [options] { return run(*options); };
}

}  // namespace

Command export_command() {
  return {"export", msg::motion_program_export_summary, msg::motion_program_export_examples, setup};
}

}  // namespace mjarm::app
