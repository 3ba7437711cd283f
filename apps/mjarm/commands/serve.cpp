#include "mjarm/core/messages/serve.hpp"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/seen_robot.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/serve/show_in_page.hpp"
#include "mjarm/session/program_player.hpp"
#include "mjarm/session/robot_session.hpp"
#include "mjarm/session/simulate_world.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot;
  std::string address, port, camera, seconds;
  bool passive = false, paused = false;
};

/// Where a browser finds the page, as one line that is there at once, whoever reads it.
void tell_address(const std::string& url) {
  std::printf("%s\n", text(msg::serve_open, url).c_str());
  std::fflush(stdout);
}

Result<serve::PageOptions> page_options(const Options& options) {
  serve::PageOptions page;
  page.on_open = tell_address;
  page.token = environment("MJARM_SERVE_TOKEN").value_or("");  // arguments are seen by everybody
  if (!options.address.empty()) page.server.address = options.address;
  if (!options.port.empty()) {
    const Result<std::uint64_t> port = parse_whole("--port", options.port);
    if (!port) return fail(port.error());
    if (*port > 65535) return fail(Errc::usage, text(msg::serve_bad_port, *port));
    page.server.port = static_cast<int>(*port);
  }
  const Result<double> seconds = parse_show_seconds(options.seconds);
  if (!seconds) return fail(seconds.error());
  page.seconds = *seconds;
  return page;
}

Result<int> done(const Result<void>& shown) {
  if (!shown) return fail(shown.error());
  return 0;
}

Result<int> run(const Options& options) {
  Result<serve::PageOptions> page = page_options(options);
  if (!page) return fail(std::move(page.error()));
  const Result<SeenRobot> seen = load_seen_robot(options.robot, msg::serve_which);
  if (!seen) return fail(seen.error());
  Result<session::FreeSim> sim = make_free_sim(*seen, options.passive);
  if (!sim) return fail(std::move(sim.error()));
  view::WindowOptions window{
      .paused = options.paused, .can_target = sim->is_held(), .jog_dofs = sim->jog_dofs()};
  if (auto set = set_camera(options.camera, seen->model, window); !set) return fail(set.error());
  catch_interrupts();
  if (options.paused) sim->handle(view::PauseEvent{true});
  session::RobotSession world(seen->model, seen->arm, *sim);
  if (session::TargetControl* target = world.target()) {
    page->target = &target->link();
    page->turns = target->target().turns();
  }
  return done(serve::show_in_page(
      seen->model, "mjarm " + std::string(seen->model.name()), window, *page,
      [&world](view::ViewLink& link) { session::simulate_world(world, link, language()); }));
}

Result<int> run_program(const Options& options) {
  const Result<serve::PageOptions> page = page_options(options);
  if (!page) return fail(page.error());
  const Result<program::LoadedProgram> loaded = load_seen_program(options.robot, options.passive);
  if (!loaded) return fail(loaded.error());
  view::WindowOptions window{.paused = options.paused};
  if (auto set = set_camera(options.camera, loaded->robot.model, window); !set) {
    return fail(set.error());
  }
  Result<session::ProgramPlayer> player = session::ProgramPlayer::create(*loaded);
  if (!player) return fail(std::move(player.error()));
  if (options.paused) player->handle(view::PauseEvent{true});
  return done(serve::show_in_page(
      loaded->robot.model, "mjarm " + loaded->program.name, window, *page,
      [&player](view::ViewLink& link) { session::simulate_world(*player, link, language()); }));
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "file", options->robot.robot, msg::view_file, "FILE");
  add_option(app, "--tip", options->robot.tip, msg::app_option_tip, "FRAME");
  add_load_options(app, options->robot);
  add_option(app, "--port", options->port, msg::serve_option_port, "PORT");
  add_option(app, "--address", options->address, msg::serve_option_address, "ADDRESS");
  add_flag(app, "--passive", options->passive, msg::view_option_passive);
  add_flag(app, "--paused", options->paused, msg::view_option_paused);
  add_option(app, "--camera", options->camera, msg::view_option_camera, "CAMERA");
  add_option(app, "--seconds", options->seconds, msg::serve_option_seconds, "S");
  return [options] {
    return program::is_program(options->robot.robot) ? run_program(*options) : run(*options);
  };
}

}  // namespace

Command serve_command() { return {"serve", msg::serve_summary, msg::serve_examples, setup}; }

}  // namespace mjarm::app
