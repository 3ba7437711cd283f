#include "python/src/run.hpp"

#include <utility>

#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/output_folder.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/session/motion_view.hpp"
#include "mjarm/session/program_scene.hpp"
#include "mjarm/session/render_program.hpp"
#include "mjarm/session/run_charts.hpp"
#include "mjarm/session/run_output.hpp"

namespace mjarm::python {

BoundRun::BoundRun(program::LoadedProgram loaded, const Choice& choice)
    : loaded_(std::move(loaded)), choice_(choice), run_(loaded_.robot.model, loaded_.robot.arm) {}

Result<std::unique_ptr<BoundRun>> BoundRun::execute(program::LoadedProgram loaded,
                                                    const Choice& choice, const StopCheck& stop) {
  std::unique_ptr<BoundRun> self(new BoundRun(std::move(loaded), choice));
  const program::ProgramPlan& plan = self->loaded_.plan;
  MotionRun& run = self->run_;
  const double steps = (plan.duration() + choice.rest) / self->loaded_.robot.model.timestep();
  Progress progress(text(msg::show_running), static_cast<std::uint64_t>(steps));
  run.set_after_step([&](const Sim& sim, MotionPart part) {
    progress.advance();
    self->trail_.set_pen(session::pen_of(part));
    self->trail_.add(sim.tool(run.arm()).p);
    return !is_stopped(stop);
  });
  if (auto done = run.execute(plan, self->loaded_.control(), choice.rest); !done) {
    return fail(std::move(done.error()));
  }
  run.set_after_step({});
  self->measured_ = run.measured_runs();
  self->report_ = run.report(plan, self->measured_, choice.tolerance);
  self->report_.name = self->loaded_.program.name;
  self->report_.control = name(self->loaded_.control());
  return self;
}

render::Plot BoundRun::plot() const {
  return session::run_plot(report_.name, report_.control, report_, loaded_.robot.arm,
                           {measured_, run_.ink()}, choice_.tolerance);
}

render::Overlay BoundRun::overlay() const {
  render::Overlay all;
  session::add_planned_paths(all, loaded_.plan);
  trail_.draw(all);
  return all;
}

render::Camera BoundRun::camera(bool film, double aspect) const {
  const Robot& robot = loaded_.robot;
  return {.view = session::motion_view(robot.model, robot.arm, session::outline_of(loaded_.plan),
                                       film, aspect)};
}

Result<render::Image> BoundRun::picture(int width, int height) const {
  Result<render::OffscreenRenderer> renderer = render::OffscreenRenderer::create(
      loaded_.robot.model, {.width = width, .height = height, .supersampling = 2});
  if (!renderer) return fail(std::move(renderer.error()));
  return renderer->draw(run_.sim().snapshot(), camera(false, 1.0 * width / height), overlay());
}

Result<std::string> BoundRun::film(const session::PictureOptions& options,
                                   const StopCheck& stop) const {
  return session::render_program(
      loaded_, options, camera(options.video, 1.0 * options.width / options.height), {}, stop);
}

Result<void> BoundRun::save(const std::filesystem::path& folder, bool overwrite) const {
  const Result<OutputFolder> open = OutputFolder::open(folder, {.overwrite = overwrite});
  if (!open) return fail(open.error());
  const session::RunOutput output{report_, plot(), overlay(), camera(false, 16.0 / 9), false};
  auto written = recorder().write_csv(folder / "log.csv").and_then([&] {
    return session::write_output(folder, loaded_.robot.model, run_.sim().snapshot(), output);
  });
  if (written) open->made();
  return written;
}

}  // namespace mjarm::python
