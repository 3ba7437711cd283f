#include "apps/mjarm/commands/run_output.hpp"

#include <cstdio>
#include <numbers>
#include <system_error>

#include "apps/mjarm/messages/demo.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::app {
namespace {

Result<void> write_picture(const std::filesystem::path& file, const Model& model,
                           const Snapshot& snapshot, const RunOutput& output) {
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(model);
  if (!renderer) {
    if (renderer.error().code != Errc::not_available) return fail(std::move(renderer.error()));
    log_warning(text(msg::demo_no_picture, renderer.error().what));
    return {};
  }
  Camera camera;
  camera.name = output.camera;
  const Result<Image> image = renderer->draw(snapshot, camera, output.overlay);
  if (!image) return fail(image.error());
  return write_png(*image, file);
}

}  // namespace

Result<void> write_output(const std::filesystem::path& folder, const Model& model,
                          const Snapshot& snapshot, const RunOutput& output) {
  return write_file(folder / "report.json", to_json(output.report))
      .and_then([&] {
        return output.plot.panels.empty() ? Result<void>()
                                          : save_plot(output.plot, folder / "plot");
      })
      .and_then([&] { return write_picture(folder / "picture.png", model, snapshot, output); });
}

int conclude(const Report& report, const std::filesystem::path& out) {
  if (!report.ok) {
    log_error(text(msg::demo_not_ok, report.name, report.reason, report.detail));
  } else if (report.path_error) {
    log_info(text(msg::demo_ok_path, report.name, 1e3 * report.path_error->max,
                  1e3 * report.path_error->rms, 100 * report.done));
  } else if (report.static_error) {
    log_info(text(msg::demo_ok_static, report.name, 1e3 * report.static_error->position,
                  report.static_error->rotation * 180 / std::numbers::pi));
  } else {
    log_info(text(msg::demo_ok, report.name));
  }
  if (report.rtf) log_info(text(msg::demo_rtf, report.duration, *report.rtf));
  std::printf("%s\n", text(msg::demo_folder, out.string()).c_str());
  return report.ok ? 0 : 1;
}

}  // namespace mjarm::app
