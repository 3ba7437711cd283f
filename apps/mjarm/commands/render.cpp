#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>

#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/commands/render_options.hpp"
#include "apps/mjarm/messages/render_command.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/session/motion_view.hpp"
#include "mjarm/session/render_program.hpp"
#include "mjarm/session/run_video.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot;
  PictureArguments picture;
};

/// Keyframe `home`, else the arm's own home, else as the model starts.
Snapshot home_of(const Model& model) {
  Sim sim(model);
  if (sim.reset("home")) return sim.snapshot();
  if (const Result<Arm> arm = find_arm(model)) sim.place(*arm, as_span(arm->home));
  return sim.snapshot();
}

/// Once around, from where the camera stands; the last frame goes on to the first.
Result<std::string> turntable(const Model& model, const PictureRequest& options) {
  constexpr double kSeconds = 5;
  const Result<render::Camera> camera = choose_camera(model, options.camera);
  if (!camera) return fail(camera.error());
  Result<session::VideoOfRun> video = session::VideoOfRun::open(model, options, *camera);
  if (!video) return fail(std::move(video.error()));
  const Snapshot home = home_of(model);
  render::Scene scene(model, render::RenderQuality::low);  // knows where cameras stand
  Result<void> set = scene.set_state(home).and_then([&] { return scene.set_camera(*camera); });
  if (!set) return fail(std::move(set.error()));
  const render::CameraView from = scene.view();
  const auto frames =
      static_cast<int>(std::max(1.0, std::round(options.seconds.value_or(kSeconds) * options.fps)));
  Progress progress(text(msg::render_command_progress), static_cast<std::uint64_t>(frames));
  for (int i = 0; i < frames; ++i) {
    render::CameraView around = from;
    around.azimuth += 2 * std::numbers::pi * i / frames;
    if (!video->add(home, {.view = around}, {})) break;
    progress.advance();
  }
  if (Result<void> finished = video->finish(); !finished) return fail(finished.error());
  return video->summary();
}

Result<std::string> picture(const Model& model, const PictureRequest& options) {
  if (options.seconds) {
    return fail(Errc::usage, text(msg::render_command_video_only, "--seconds"));
  }
  const Result<render::Camera> camera = choose_camera(model, options.camera);
  if (!camera) return fail(camera.error());
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(model, session::offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  return session::write_picture(*renderer, options, home_of(model), *camera, {});
}

Result<std::string> program_picture(const std::string& file, const PictureRequest& wanted) {
  const Result<program::LoadedProgram> loaded = program::load_sound_program(file, interrupted);
  if (!loaded) return fail(loaded.error());
  const Robot& robot = loaded->robot;
  Result<render::Camera> camera = choose_camera(robot.model, wanted.camera);
  if (!camera) return fail(camera.error());
  if (wanted.camera.empty()) {
    camera->view = session::motion_view(robot.model, robot.arm, session::outline_of(loaded->plan),
                                        wanted.video, 1.0 * wanted.width / wanted.height);
  }
  return session::render_program(*loaded, wanted, *camera, wanted.seconds);
}

Result<std::string> render(const Options& options, const PictureRequest& wanted) {
  if (program::is_program(options.robot.robot)) return program_picture(options.robot.robot, wanted);
  const Result<Model> model = load_model(options.robot);
  if (!model) return fail(model.error());
  tell_warnings(*model);
  return wanted.video ? turntable(*model, wanted) : picture(*model, wanted);
}

Result<int> run(const Options& options) {
  if (options.robot.robot.empty()) return fail(Errc::usage, text(msg::render_command_which));
  const Result<PictureRequest> wanted = read_picture_options(options.picture);
  if (!wanted) return fail(wanted.error());
  const Result<std::string> line = render(options, *wanted);
  if (!line) return fail(line.error());
  std::printf("%s\n", line->c_str());
  return 0;
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_option(app, "file", options->robot.robot, msg::render_command_file, "FILE|PROGRAM");
  add_picture_options(app, options->picture);
  add_package_path_option(app, options->robot.package_paths);
  add_outside_option(app, options->robot.allow_outside);
  return [options] { return run(*options); };
}

}  // namespace

Command render_command() {
  return {"render", msg::render_command_summary, msg::render_command_examples, setup};
}

}  // namespace mjarm::app
