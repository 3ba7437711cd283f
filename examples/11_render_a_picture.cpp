// A picture of a robot with the path of its tool, without a window.
#include <cstdio>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/render/png.hpp"

int main() {
  const auto robot = mjarm::load_robot("ur5e");
  if (!robot) return std::fprintf(stderr, "%s\n", robot.error().what.c_str()), 1;
  const auto& [model, arm] = *robot;

  auto renderer = mjarm::render::OffscreenRenderer::create(model, {.width = 640, .height = 360});
  if (!renderer && renderer.error().code == mjarm::Errc::not_available) {
    return std::printf("no picture on this machine: %s\n", renderer.error().what.c_str()), 0;
  }
  if (!renderer) return std::fprintf(stderr, "%s\n", renderer.error().what.c_str()), 1;

  const Eigen::Matrix3d down = mjarm::from_euler({3.14, 0, 0});
  const auto ellipse =
      mjarm::Curve::ellipse({{0, -0.5, 0.4}, 0.3, 0.15, Eigen::Vector3d::UnitZ(), down});
  if (!ellipse) return std::fprintf(stderr, "%s\n", ellipse.error().what.c_str()), 1;
  mjarm::render::Overlay overlay;
  mjarm::render::add_planned_path(overlay, ellipse->poses(ellipse->stations(0.01, 0.1)));

  mjarm::Sim sim(model);
  sim.place(arm, mjarm::as_span(arm.home));
  const auto image = renderer->draw(sim.snapshot(), {.name = "overview"}, overlay);
  if (!image) return std::fprintf(stderr, "%s\n", image.error().what.c_str()), 1;
  const auto written = mjarm::render::write_png(*image, "picture.png");
  if (!written) return std::fprintf(stderr, "%s\n", written.error().what.c_str()), 1;
  std::printf("picture.png, %d x %d pixels, drawn with %s\n", image->width, image->height,
              renderer->gl().renderer().c_str());
}
