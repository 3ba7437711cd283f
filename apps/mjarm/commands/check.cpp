#include <memory>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/print.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/commands/program_text.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/motion_program.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string file;
  RobotChoice robot;  // that the program names: how its files are read
  bool json = false;
};

/// Lists what is wrong with a text that cannot even be planned; nothing where that is not it.
void tell_text_faults(const Options& options) {
  const auto file = program::find_program_file(options.file);
  if (!file) return;
  const auto faults = program::find_text_faults(*file, load_options(options.robot));
  if (!faults || faults->empty()) return;
  const std::string out =
      options.json ? faults_json(*faults).document() : faults_text(file->string(), *faults);
  print_lines(out);
}

Result<int> run(const Options& options) {
  if (options.file.empty()) return fail(Errc::usage, text(msg::motion_program_which));
  catch_interrupts();
  const Result<program::LoadedProgram> loaded = program::load_program(
      options.file, interrupted, load_options(options.robot), session::see_scene);
  if (!loaded) {
    tell_text_faults(options);
    return fail(loaded.error());
  }
  const std::string out = options.json ? plan_json(*loaded).document() : plan_text(*loaded);
  print_lines(out);
  if (!loaded->plan.ok()) return fail(program::first_fault(*loaded));
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "program", options->file, msg::motion_program_file, "PROGRAM.yaml");
  add_load_options(app, options->robot);
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command check_command() {
  return {"check", msg::motion_program_check_summary, msg::motion_program_check_examples, setup};
}

}  // namespace mjarm::app
