#include "mjarm/core/messages/serve.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/commands/page_options.hpp"
#include "apps/mjarm/commands/seen_robot.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/serve/show_in_page.hpp"
#include "mjarm/session/program_player.hpp"
#include "mjarm/session/robot_session.hpp"
#include "mjarm/session/simulate_world.hpp"

namespace mjarm::app {
namespace {

constexpr std::size_t kMaxRecording = std::size_t{256} << 20;  // [bytes]

struct Options {
  RobotChoice robot;
  ServeArguments serve;
  std::string camera, seconds, replay;
  bool passive = false, paused = false;
};

Result<serve::PageOptions> page_options(const Options& options) {
  Result<serve::PageOptions> page = read_serve_options(options.serve);
  if (!page) return page;
  const Result<double> seconds = parse_show_seconds(options.seconds);
  if (!seconds) return fail(seconds.error());
  page->seconds = *seconds;
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

/// The page of a recorded run: the file, or the only one in the folder.
Result<std::filesystem::path> recorded_page(const std::filesystem::path& where) {
  std::error_code code;
  if (!std::filesystem::is_directory(where, code)) return where;
  std::vector<std::filesystem::path> pages;
  for (const auto& entry : std::filesystem::directory_iterator(where, code)) {
    if (entry.path().extension() == ".html") pages.push_back(entry.path());
  }
  if (pages.size() == 1) return pages.front();
  const Msg& why = pages.empty() ? msg::serve_no_recording : msg::serve_many_recordings;
  return fail(Errc::bad_input, text(why, where.string(), where.string()));
}

Result<int> replay(const Options& options) {
  if (!options.robot.robot.empty()) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "FILE", "--replay"));
  }
  if (options.passive || options.paused || !options.camera.empty() || !options.robot.tip.empty()) {
    return fail(Errc::usage, text(msg::serve_replay_alone));
  }
  const Result<serve::PageOptions> page = page_options(options);
  if (!page) return fail(page.error());
  const Result<std::filesystem::path> file = recorded_page(options.replay);
  if (!file) return fail(file.error());
  Result<std::string> html = read_file(*file, kMaxRecording);
  if (!html) return fail(std::move(html.error()));
  if (html->find("id=\"run-bytes\"") == std::string::npos) {
    return fail(Errc::bad_input, text(msg::serve_not_recorded, file->string()));
  }
  catch_interrupts();
  return done(serve::show_run_page(std::move(*html), *page));
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "file", options->robot.robot, msg::view_file, "FILE");
  add_option(app, "--tip", options->robot.tip, msg::app_option_tip, "FRAME");
  add_load_options(app, options->robot);
  add_serve_options(app, options->serve);
  add_flag(app, "--passive", options->passive, msg::view_option_passive);
  add_flag(app, "--paused", options->paused, msg::view_option_paused);
  add_option(app, "--replay", options->replay, msg::serve_option_replay, "DIR|FILE.html");
  add_option(app, "--camera", options->camera, msg::view_option_camera, "CAMERA");
  add_option(app, "--seconds", options->seconds, msg::serve_option_seconds, "S");
  return [options] {
    if (!options->replay.empty()) return replay(*options);
    return program::is_program(options->robot.robot) ? run_program(*options) : run(*options);
  };
}

}  // namespace

Command serve_command() { return {"serve", msg::serve_summary, msg::serve_examples, setup}; }

}  // namespace mjarm::app
