// Time of one frame by quality, 1280 x 720, the shipped UR5e scene: run from the repository's root.
#include <benchmark/benchmark.h>

#include <cmath>

#include "mjarm/render/offscreen.hpp"

namespace mjarm::render {
namespace {

constexpr const char* kScene = "models/universal_robots_ur5e/scene.xml";

/// @param trail  points of a line that is drawn as well.
void draw(benchmark::State& state, RenderQuality quality, int trail) {
  const Result<Model> model = Model::load(kScene);
  if (!model) return state.SkipWithError(model.error().what.c_str());
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(*model, {.quality = quality});
  if (!renderer) return state.SkipWithError(renderer.error().what.c_str());
  Sim sim(*model);
  if (Result<void> home = sim.reset("home"); !home) {
    return state.SkipWithError(home.error().what.c_str());
  }
  Overlay overlay;
  OverlayLine& line = overlay.lines.emplace_back();
  for (int i = 0; i < trail; ++i) {
    const double angle = 0.01 * i;
    line.points_W.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.4);
  }
  const Snapshot snapshot = sim.snapshot();
  const Camera camera{.name = "overview"};
  for (auto _ : state) {
    const Result<Image> image = renderer->draw(snapshot, camera, overlay);
    if (!image) return state.SkipWithError(image.error().what.c_str());
    benchmark::DoNotOptimize(image->rgb.data());
  }
  state.SetLabel(renderer->gl().renderer());
}

#define MJARM_BENCH(name, ...)               \
  BENCHMARK_CAPTURE(draw, name, __VA_ARGS__) \
      ->Unit(benchmark::kMillisecond)        \
      ->UseRealTime()                        \
      ->MinTime(2)
MJARM_BENCH(low, RenderQuality::low, 0);
MJARM_BENCH(medium, RenderQuality::medium, 0);
MJARM_BENCH(high, RenderQuality::high, 0);
MJARM_BENCH(low_trail, RenderQuality::low, 600);
MJARM_BENCH(high_trail, RenderQuality::high, 600);

}  // namespace
}  // namespace mjarm::render
