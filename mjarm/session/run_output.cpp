#include "mjarm/session/run_output.hpp"

#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::session {

void remove_stale(const std::filesystem::path& folder, std::initializer_list<const char*> names) {
  std::error_code ignored;
  for (const char* const name : names) std::filesystem::remove(folder / name, ignored);
}

Result<void> write_end_picture(const std::filesystem::path& folder, const Model& model,
                               const Snapshot& snapshot, const render::Camera& camera,
                               const render::Overlay& overlay) {
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(model, {.supersampling = 2});
  if (!renderer) {
    if (renderer.error().code != Errc::not_available) return fail(std::move(renderer.error()));
    remove_stale(folder, {"picture.png"});
    log_warning(text(msg::show_no_picture, renderer.error().what));
    return {};
  }
  const Result<render::Image> image = renderer->draw(snapshot, camera, overlay);
  if (!image) return fail(image.error());
  return render::write_png(*image, folder / "picture.png");
}

Result<void> write_output(const std::filesystem::path& folder, const Model& model,
                          const Snapshot& snapshot, const RunOutput& output) {
  if (output.plot.panels.empty()) remove_stale(folder, {"plot.png", "plot.svg"});
  if (!output.film) remove_stale(folder, {kVideoFile});
  return write_file(folder / "report.json", to_json(output.report))
      .and_then([&] {
        return output.plot.panels.empty() ? Result<void>()
                                          : render::save_plot(output.plot, folder / "plot");
      })
      .and_then([&] {
        return write_end_picture(folder, model, snapshot, output.camera, output.overlay);
      });
}

}  // namespace mjarm::session
