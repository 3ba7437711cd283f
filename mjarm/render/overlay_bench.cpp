#include <benchmark/benchmark.h>

#include <cmath>

#include "mjarm/model/describe.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/render/trail.hpp"

namespace mjarm::render {
namespace {

/// Frames of the UR5e with a trail of so many points, drawn in the look and quality given. The
/// CPU time is that of all threads, as a software renderer has many.
void trail_frame(benchmark::State& state, RenderQuality quality, LineLook look) {
  const auto file = find_model_file("ur5e");
  if (!file) return state.SkipWithError(file.error().what.c_str());
  const Result<Model> model = Model::load(*file);
  if (!model) return state.SkipWithError(model.error().what.c_str());
  Result<OffscreenRenderer> renderer = OffscreenRenderer::create(*model, {.quality = quality});
  if (!renderer) return state.SkipWithError(renderer.error().what.c_str());
  Trail trail({.max_points = 20000});
  for (int i = 0; i <= state.range(0); ++i) {
    const double a = 0.005 * i;  // 2 mm a point
    trail.add({0.5 * std::cos(a), 0.3 * std::sin(a), 0.4 + 5e-5 * i});
  }
  Overlay overlay;
  trail.draw(overlay);
  for (OverlayLine& line : overlay.lines) line.look = look;
  for (auto _ : state) {
    if (!renderer->draw({}, {}, overlay)) return state.SkipWithError("drawing failed");
  }
}

void bm_trail_low_thin(benchmark::State& state) {
  trail_frame(state, RenderQuality::low, LineLook::thin);
}
void bm_trail_low_tube(benchmark::State& state) {
  trail_frame(state, RenderQuality::low, LineLook::tube);
}
void bm_trail_low(benchmark::State& state) {
  trail_frame(state, RenderQuality::low, LineLook::automatic);
}
void bm_trail_high(benchmark::State& state) {
  trail_frame(state, RenderQuality::high, LineLook::automatic);
}
BENCHMARK(bm_trail_low_thin)
    ->Arg(0)
    ->Arg(2000)
    ->Arg(10000)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(bm_trail_low_tube)
    ->Arg(300)
    ->Arg(2000)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(bm_trail_low)
    ->Arg(0)
    ->Arg(300)
    ->Arg(2000)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(bm_trail_high)
    ->Arg(0)
    ->Arg(2000)
    ->Arg(10000)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mjarm::render
