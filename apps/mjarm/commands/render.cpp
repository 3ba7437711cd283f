#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/render_options.hpp"
#include "apps/mjarm/commands/sim_options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/render_command.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/motion_view.hpp"
#include "mjarm/session/render_program.hpp"
#include "mjarm/session/run_model.hpp"
#include "mjarm/session/run_video.hpp"
#include "mjarm/session/see_scene.hpp"

namespace mjarm::app {
namespace {

constexpr double kSeconds = 5;  // of a model's video
constexpr int kMostInStrip = 24;

struct Options {
  RobotChoice robot;
  PictureArguments picture;
  SimArguments sim;
  bool turn = false;
  std::string strip;
};

/// A model that is drawn, and how.
struct Job {
  const Model& model;
  const PictureRequest& wanted;
  const SimArguments& sim;
  render::Camera camera;
};

int frame_count(const PictureRequest& wanted) {
  const double frames = std::round(wanted.seconds.value_or(kSeconds) * wanted.fps);
  return static_cast<int>(std::max(1.0, frames));
}

/// Once around the model as it starts, from where the camera stands; the last frame goes on to the
/// first.
Result<std::string> turntable(const Job& job) {
  const Result<session::ModelStart> start = read_start(job.model, job.sim);
  if (!start) return fail(start.error());
  const Result<Sim> sim = session::start_model(job.model, *start);
  if (!sim) return fail(sim.error());
  Result<session::VideoOfRun> video = session::VideoOfRun::open(job.model, job.wanted, job.camera);
  if (!video) return fail(std::move(video.error()));
  const Snapshot still = sim->snapshot();
  render::Scene scene(job.model, render::RenderQuality::low);  // knows where cameras stand
  Result<void> set = scene.set_state(still).and_then([&] { return scene.set_camera(job.camera); });
  if (!set) return fail(std::move(set.error()));
  const render::CameraView from = scene.view();
  const int frames = frame_count(job.wanted);
  Progress progress(text(msg::render_command_progress), static_cast<std::uint64_t>(frames));
  for (int i = 0; i < frames; ++i) {
    render::CameraView around = from;
    around.azimuth += 2 * std::numbers::pi * i / frames;
    if (!video->add(still, {.view = around}, {})) break;
    progress.advance();
  }
  if (Result<void> finished = video->finish(); !finished) return fail(finished.error());
  return video->summary();
}

/// The model as it moves by itself, by its physics.
Result<std::string> motion_video(const Job& job) {
  const auto how = read_sim_options(job.model, job.sim, job.wanted.seconds.value_or(kSeconds));
  if (!how) return fail(how.error());
  Result<Sim> sim = session::start_model(job.model, how->start);
  if (!sim) return fail(std::move(sim.error()));
  Result<session::VideoOfRun> video = session::VideoOfRun::open(job.model, job.wanted, job.camera);
  if (!video) return fail(std::move(video.error()));
  const int frames = frame_count(job.wanted);
  const Result<bool> whole = session::run_model(*sim, *how, [&](const Sim& now, auto) {
    return video->frames() >= frames || video->step(now, {});
  });
  if (!whole) return fail(whole.error());
  if (Result<void> finished = video->finish(); !finished) return fail(finished.error());
  return video->summary();
}

/// The model as it starts or, with --seconds, as it is so much later.
Result<std::string> picture(const Job& job) {
  const std::string given = first_given(job.sim);
  if (!job.wanted.seconds && given.starts_with("--ctrl")) {
    return fail(Errc::usage, text(msg::render_command_needs_seconds, given));
  }
  session::ModelRunOptions how;
  if (job.wanted.seconds) {
    auto read = read_sim_options(job.model, job.sim, *job.wanted.seconds);
    if (!read) return fail(std::move(read.error()));
    how = std::move(*read);
  } else {
    auto start = read_start(job.model, job.sim);
    if (!start) return fail(std::move(start.error()));
    how.start = std::move(*start);
  }
  Result<Sim> sim = session::start_model(job.model, how.start);
  if (!sim) return fail(std::move(sim.error()));
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(job.model, session::offscreen_options(job.wanted));
  if (!renderer) return fail(std::move(renderer.error()));
  if (job.wanted.seconds) {
    const auto whole = session::run_model(*sim, how, [](const Sim&, auto) { return true; });
    if (!whole) return fail(whole.error());
    if (!*whole) return fail(stopped());
  }
  return session::write_picture(*renderer, job.wanted, sim->snapshot(), job.camera, {});
}

Result<std::string> program_picture(const RobotChoice& chosen, const PictureRequest& wanted) {
  const Result<program::LoadedProgram> loaded = program::load_sound_program(
      chosen.robot, interrupted, load_options(chosen), session::see_scene);
  if (!loaded) return fail(loaded.error());
  const Robot& robot = loaded->robot;
  Result<render::Camera> camera = choose_camera(robot.model, wanted.camera);
  if (!camera) return fail(camera.error());
  if (wanted.camera.empty()) {
    constexpr double kWhole = std::numeric_limits<double>::infinity();
    const auto outline = session::outline_of(loaded->plan, wanted.seconds.value_or(kWhole));
    camera->view = session::motion_view(robot.model, robot.arm, outline, wanted.video,
                                        1.0 * wanted.width / wanted.height);
  }
  return session::render_program(*loaded, wanted, *camera, wanted.seconds);
}

/// Options that would do nothing are a mistake.
Result<void> check_use(const Options& options, const PictureRequest& wanted) {
  const bool program = program::is_program(options.robot.robot);
  const std::string given = options.turn ? "--turn" : first_given(options.sim);
  if (program && !given.empty()) {
    return fail(Errc::usage, text(msg::render_command_not_program, given));
  }
  if (!options.strip.empty() && (!program || wanted.video)) {
    return fail(Errc::usage, text(msg::render_command_strip_of_program));
  }
  if (options.turn && !wanted.video) {
    return fail(Errc::usage, text(msg::render_command_video_only, "--turn"));
  }
  if (const std::string sim = first_given(options.sim); options.turn && sim.starts_with("--ctrl")) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--turn", sim));
  }
  return {};
}

Result<std::string> render(const Options& options, const PictureRequest& wanted) {
  if (auto used = check_use(options, wanted); !used) return fail(std::move(used.error()));
  if (program::is_program(options.robot.robot)) return program_picture(options.robot, wanted);
  const Result<Model> model = load_model(options.robot);
  if (!model) return fail(model.error());
  tell_warnings(*model);
  const Result<render::Camera> camera = choose_camera(*model, wanted.camera);
  if (!camera) return fail(camera.error());
  const Job job{*model, wanted, options.sim, *camera};
  if (options.turn) return turntable(job);
  return wanted.video ? motion_video(job) : picture(job);
}

Result<int> run(const Options& options) {
  if (options.robot.robot.empty()) return fail(Errc::usage, text(msg::render_command_which));
  Result<PictureRequest> wanted = read_picture_options(options.picture);
  if (!wanted) return fail(wanted.error());
  if (!options.strip.empty()) {
    const Result<int> count = parse_count("--strip", options.strip, kMostInStrip, 2);
    if (!count) return fail(count.error());
    wanted->strip = *count;
  }
  const auto result = LongResult::begin(options.picture.out, options.picture.replace);
  if (!result) return fail(result.error());
  const Result<std::string> line = render(options, *wanted);
  if (!line) return fail(line.error());
  result->made();
  std::printf("%s\n", line->c_str());
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "file", options->robot.robot, msg::render_command_file, "FILE|PROGRAM");
  add_picture_options(app, options->picture);
  add_option(app, "--strip", options->strip, msg::render_command_option_strip, "N");
  add_flag(app, "--turn", options->turn, msg::render_command_option_turn);
  add_sim_options(app, options->sim);
  add_load_options(app, options->robot);
  return [options] { return run(*options); };
}

}  // namespace

Command render_command() {
  return {"render", msg::render_command_summary, msg::render_command_examples, setup};
}

}  // namespace mjarm::app
