#include "mjarm/session/render_program.hpp"

#include <functional>
#include <optional>
#include <utility>

#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/execution/execution.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/session/program_scene.hpp"
#include "mjarm/session/run_video.hpp"

namespace mjarm::session {
namespace {

/// Executes a plan, with the trail of the tool in an overlay.
class ProgramRun {
 public:
  explicit ProgramRun(const program::LoadedProgram& loaded)
      : loaded_(loaded), sim_(loaded.robot.model) {
    sim_.reset_home();
    sim_.hold_others(loaded.robot.arm);
    sim_.place(loaded.robot.arm, as_span(loaded.plan.q_start));
    add_planned_paths(planned_, loaded.plan);
  }

  /// @param seconds     [s] of simulated time at most.
  /// @param after_step  returns false to stop; called once before anything moves.
  Result<void> run(std::optional<double> seconds, const std::function<bool()>& after_step) {
    if (!after_step()) return {};
    const program::ProgramPlan& plan = loaded_.plan;
    Result<Execution> execution =
        Execution::create(loaded_.robot.model, plan, {.control = loaded_.control()});
    if (!execution) return fail(std::move(execution.error()));
    const auto done = execution->run_to_end(sim_, [&](const Sim& sim) {
      const std::size_t move = execution->motions().back().move;
      trail_.set_pen(pen_of(plan.part(move)));
      trail_.add(sim.tool(plan.arms[plan.moves[move].tool]).p);
      return after_step() && !(seconds && sim.time() >= *seconds);
    });
    if (!done) return fail(Errc::impossible, done.error().what);
    return {};
  }

  [[nodiscard]] const Sim& sim() const { return sim_; }
  [[nodiscard]] render::Overlay overlay() const {
    render::Overlay all = planned_;
    trail_.draw(all);
    return all;
  }

 private:
  const program::LoadedProgram& loaded_;
  Sim sim_;
  render::Overlay planned_;
  render::Trail trail_{{.max_points = 10000}};
};

/// What is asked of a picture or a video.
struct Job {
  const Model& model;
  const PictureOptions& options;
  const render::Camera& camera;
  std::optional<double> seconds;
  const StopCheck& stop;

  [[nodiscard]] Error stopped() const {
    return {Errc::system, text(msg::show_stopped, options.out.string())};
  }
};

Result<std::string> video_of(ProgramRun& run, const Job& job, Progress& progress) {
  Result<VideoOfRun> video = VideoOfRun::open(job.model, job.options, job.camera);
  if (!video) return fail(std::move(video.error()));
  const auto after_step = [&] {
    progress.advance();
    if (is_stopped(job.stop)) return false;
    return !video->is_due(run.sim()) || video->step(run.sim(), run.overlay());
  };
  if (Result<void> ran = run.run(job.seconds, after_step); !ran) return fail(ran.error());
  if (is_stopped(job.stop)) return fail(job.stopped());
  if (Result<void> finished = video->finish(); !finished) return fail(finished.error());
  return video->summary();
}

Result<std::string> picture_of(ProgramRun& run, const Job& job, Progress& progress) {
  const PictureOptions& options = job.options;
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(job.model, offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  const auto after_step = [&] {
    progress.advance();
    return !is_stopped(job.stop);
  };
  if (Result<void> ran = run.run(job.seconds, after_step); !ran) return fail(ran.error());
  if (is_stopped(job.stop)) return fail(job.stopped());
  return write_picture(*renderer, options, run.sim().snapshot(), job.camera, run.overlay());
}

/// Pictures at even times from the beginning to the end, in one.
Result<std::string> strip_over(ProgramRun& run, const Job& job, double duration,
                               Progress& progress) {
  const PictureOptions& options = job.options;
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(job.model, offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  std::vector<render::Image> pictures;
  Result<void> drawn;
  const auto draw = [&] {
    Result<render::Image> image = renderer->draw(run.sim().snapshot(), job.camera, run.overlay());
    if (image) {
      pictures.push_back(std::move(*image));
    } else {
      drawn = fail(std::move(image.error()));
    }
    return image.has_value();
  };
  const auto after_step = [&] {
    progress.advance();
    const double due = duration * static_cast<double>(pictures.size()) / (options.strip - 1);
    const bool wanted = static_cast<int>(pictures.size()) < options.strip - 1;
    if (wanted && run.sim().time() >= due && !draw()) return false;
    return !is_stopped(job.stop);
  };
  if (Result<void> ran = run.run(job.seconds, after_step); !ran) return fail(ran.error());
  if (is_stopped(job.stop)) return fail(job.stopped());
  if (!drawn || !draw()) return fail(std::move(drawn.error()));
  return write_image(strip_of(pictures), options);
}

}  // namespace

Result<std::string> render_program(const program::LoadedProgram& loaded,
                                   const PictureOptions& options, const render::Camera& camera,
                                   std::optional<double> seconds, const StopCheck& stop) {
  const Model& model = loaded.robot.model;
  double duration = loaded.plan.duration() + kRestAtEnd;
  if (seconds) duration = std::min(duration, *seconds);
  Progress progress(text(msg::show_running),
                    static_cast<std::uint64_t>(duration / model.timestep()));
  ProgramRun run(loaded);
  const Job job{model, options, camera, seconds, stop};
  if (options.strip > 0) return strip_over(run, job, duration, progress);
  return options.video ? video_of(run, job, progress) : picture_of(run, job, progress);
}

}  // namespace mjarm::session
