#include <cstdio>
#include <memory>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/commands/program_text.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/motion_program.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {
namespace {

struct Options {
  std::string file;
  bool json = false;
};

Result<int> run(const Options& options) {
  if (options.file.empty()) return fail(Errc::usage, text(msg::motion_program_which));
  catch_interrupts();
  const Result<program::LoadedProgram> loaded = program::load_program(options.file);
  if (!loaded) return fail(loaded.error());
  const std::string out = options.json ? plan_json(*loaded).document() : plan_text(*loaded);
  std::fputs(out.c_str(), stdout);
  if (!loaded->plan.ok()) return fail(program::first_fault(*loaded));
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "program", options->file, msg::motion_program_file, "PROGRAM.yaml");
  add_flag(app, "--json", options->json, msg::app_option_json);
  return [options] { return run(*options); };
}

}  // namespace

Command check_command() {
  return {"check", msg::motion_program_check_summary, msg::motion_program_check_examples, setup};
}

}  // namespace mjarm::app
