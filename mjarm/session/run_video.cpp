#include "mjarm/session/run_video.hpp"

#include <utility>

#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::session {

Result<VideoOfRun> VideoOfRun::open(const Model& model, const PictureOptions& options,
                                    const render::Camera& camera) {
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(model, offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  Result<render::VideoWriter> writer = render::VideoWriter::create(
      options.out, {.width = options.width, .height = options.height, .fps = options.fps});
  if (!writer) return fail(std::move(writer.error()));
  return VideoOfRun(options, camera, std::move(*renderer), std::move(*writer));
}

bool VideoOfRun::add(const Snapshot& snapshot, const render::Camera& camera,
                     const render::Overlay& overlay) {
  if (error_ || interrupted()) return false;
  Result<render::Image> image = renderer_.draw(snapshot, camera, overlay);
  if (image) legend_ = render::add_legend(*image, options_.legend, legend_);
  const Result<void> added = image ? writer_.add(*image) : fail(image.error());
  if (!added) error_ = added.error();
  return !error_;
}

bool VideoOfRun::is_due(const Sim& sim) const {
  // Half a step early is as near as half a step late.
  const double half = sim.model().timestep() / 2;
  return !start_ || *start_ + frames() / options_.fps <= sim.time() + half;
}

bool VideoOfRun::step(const Sim& sim, const render::Overlay& overlay) {
  if (error_ || interrupted()) return false;
  if (!start_) start_ = sim.time();
  while (is_due(sim)) {
    if (!add(sim.snapshot(), camera_, overlay)) return false;
  }
  return true;
}

Result<void> VideoOfRun::finish() {
  if (!error_ && !interrupted()) {
    Result<void> finished = writer_.finish();
    if (finished) return {};
    error_ = std::move(finished.error());
  }
  if (interrupted()) {
    return fail(Errc::system, text(msg::show_stopped, options_.out.string()));
  }
  return fail(*error_);
}

std::string VideoOfRun::summary() const {
  return text(msg::show_video, options_.out.string(), options_.width, options_.height, frames(),
              frames() / options_.fps);
}

}  // namespace mjarm::session
