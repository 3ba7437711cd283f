#include "apps/mjarm/commands/render_program.hpp"

#include <functional>
#include <optional>
#include <utility>

#include "apps/mjarm/commands/render_video.hpp"
#include "apps/mjarm/messages/render_command.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/render/png.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/session/program_scene.hpp"

namespace mjarm::app {
namespace {

/// Executes a plan, with the trail of the tool in an overlay.
class ProgramRun {
 public:
  explicit ProgramRun(const LoadedProgram& loaded) : loaded_(loaded), sim_(loaded.robot.model) {
    sim_.place(loaded.robot.arm, as_span(loaded.plan.q_start));
    session::add_planned_paths(planned_, loaded.plan);
  }

  /// @param seconds     [s] of simulated time at most.
  /// @param after_step  returns false to stop; called once before anything moves.
  Result<void> run(std::optional<double> seconds, const std::function<bool()>& after_step) {
    if (!after_step()) return {};
    const ProgramPlan& plan = loaded_.plan;
    Result<Execution> execution =
        Execution::make(loaded_.robot.model, plan, {.control = loaded_.control()});
    if (!execution) return fail(std::move(execution.error()));
    const auto done = execution->run_to_end(sim_, [&](const Sim& sim) {
      const PlannedMove& move = plan.moves[execution->motions().back().move];
      trail_.add(sim.tool(plan.arms[move.tool]).p);
      return after_step() && !(seconds && sim.time() >= *seconds);
    });
    if (!done) return fail(Errc::impossible, done.error().what);
    return {};
  }

  [[nodiscard]] const Sim& sim() const { return sim_; }
  [[nodiscard]] Overlay overlay() const {
    Overlay all = planned_;
    trail_.draw(all);
    return all;
  }

 private:
  const LoadedProgram& loaded_;
  Sim sim_;
  Overlay planned_;
  Trail trail_{{.max_points = 10000}};
};

Result<std::string> video_of(ProgramRun& run, const Model& model, const PictureOptions& options,
                             Progress& progress) {
  Result<VideoOfRun> video = VideoOfRun::open(model, options);
  if (!video) return fail(std::move(video.error()));
  const auto after_step = [&] {
    progress.advance();
    return video->is_due(run.sim()) ? video->step(run.sim(), run.overlay()) : !interrupted();
  };
  if (Result<void> ran = run.run(options.seconds, after_step); !ran) return fail(ran.error());
  if (Result<void> finished = video->finish(); !finished) return fail(finished.error());
  return video->summary();
}

Result<std::string> picture_of(ProgramRun& run, const Model& model, const PictureOptions& options,
                               Progress& progress) {
  const Result<Camera> camera = choose_camera(model, options.camera);
  if (!camera) return fail(camera.error());
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(model, offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  const auto after_step = [&progress] {
    progress.advance();
    return !interrupted();
  };
  if (Result<void> ran = run.run(options.seconds, after_step); !ran) return fail(ran.error());
  if (interrupted()) {
    return fail(Errc::system, text(msg::render_command_stopped, options.out.string()));
  }
  return write_picture(*renderer, options, run.sim().snapshot(), *camera, run.overlay());
}

}  // namespace

Result<std::string> render_program(const std::string& file, const PictureOptions& options) {
  const Result<LoadedProgram> loaded = load_sound_program(file);
  if (!loaded) return fail(loaded.error());
  const Model& model = loaded->robot.model;
  double duration = loaded->plan.duration() + kRestAtEnd;
  if (options.seconds) duration = std::min(duration, *options.seconds);
  Progress progress(text(msg::render_command_running),
                    static_cast<std::uint64_t>(duration / model.timestep()));
  ProgramRun run(*loaded);
  return options.video ? video_of(run, model, options, progress)
                       : picture_of(run, model, options, progress);
}

Result<std::string> write_picture(OffscreenRenderer& renderer, const PictureOptions& options,
                                  const Snapshot& snapshot, const Camera& camera,
                                  const Overlay& overlay) {
  const Result<Image> image = renderer.draw(snapshot, camera, overlay);
  if (!image) return fail(image.error());
  if (Result<void> written = write_png(*image, options.out); !written) {
    return fail(std::move(written.error()));
  }
  return text(msg::render_command_picture, options.out.string(), image->width, image->height);
}

}  // namespace mjarm::app
