// What the qualities show, where shadows end, and that looking changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "mjarm/core/os.hpp"
#include "mjarm/render/offscreen.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

/// A ball above a grey floor under a light from straight above: its shadow is a disc of its own
/// radius about the origin.
constexpr const char* kShadow = R"(
<mujoco model="shadow">
  <visual>
    <headlight ambient="0.3 0.3 0.3" diffuse="0 0 0" specular="0 0 0"/>
    <map shadowclip="1"/>
    <quality shadowsize="4096"/>
  </visual>
  <statistic center="0 0 0" extent="2"/>
  <worldbody>
    <light type="directional" pos="0 0 3" dir="0 0 -1" diffuse="0.7 0.7 0.7" specular="0 0 0"/>
    <camera name="side" pos="0 -3 1.5" xyaxes="1 0 0 0 0.447 0.894" fovy="45"/>
    <geom type="plane" size="0 0 0.1" rgba="0.8 0.8 0.8 1"/>
    <geom type="sphere" size="0.3" pos="0 0 1.2" rgba="1 0 0 1"/>
  </worldbody>
</mujoco>)";

constexpr const char* kArm = R"(
<mujoco model="two">
  <option timestep="0.002" integrator="implicitfast"/>
  <worldbody>
    <geom type="plane" size="0 0 0.1"/>
    <body pos="0 0 0.5">
      <joint name="a" axis="0 1 0" range="-3 3" limited="true" armature="0.1"/>
      <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/>
      <body pos="0.3 0 0">
        <joint name="b" axis="0 1 0" range="-3 3" limited="true" armature="0.1"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.03"/>
        <site name="tool" pos="0.3 0 0"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position joint="a" kp="200" kv="20" ctrlrange="-3 3"/>
    <position joint="b" kp="200" kv="20" ctrlrange="-3 3"/>
  </actuator>
</mujoco>)";

Result<Model> load_mjcf(const char* mjcf) {
  const support::TempFolder folder;
  return Model::load(folder.write("model.xml", mjcf));
}

int brightness(const Image& image, int x, int y) {
  const auto [r, g, b] = image.pixel(x, y);
  return r + g + b;
}

TEST(Quality, EachShowsMoreThanTheOneBelow) {
  const Result<Model> model = load_mjcf(kShadow);
  ASSERT_TRUE(model) << model.error().what;
  std::vector<Image> images;
  for (const RenderQuality quality :
       {RenderQuality::low, RenderQuality::medium, RenderQuality::high}) {
    Result<OffscreenRenderer> renderer =
        OffscreenRenderer::create(*model, {.width = 320, .height = 240, .quality = quality});
    if (!renderer) GTEST_SKIP() << renderer.error().what;
    EXPECT_EQ(renderer->quality(), quality);
    const Result<Image> image = renderer->draw({}, {.name = "side"});
    ASSERT_TRUE(image) << image.error().what;
    images.push_back(*image);
  }
  // The origin is seen in the middle of the picture, 0.8 m to its right is in the light.
  const auto shaded = [&](const Image& image) {
    return brightness(image, 230, 120) - brightness(image, 160, 120);
  };
  EXPECT_NEAR(shaded(images[0]), 0, 20);
  EXPECT_GT(shaded(images[1]), 100);
  EXPECT_GT(shaded(images[2]), 100);
  EXPECT_NE(images[1].rgb, images[2].rgb);
}

TEST(Quality, TheProcessorGetsItsOwn) {
  const Result<Model> model = load_mjcf(kShadow);
  ASSERT_TRUE(model);
  const Result<OffscreenRenderer> renderer = OffscreenRenderer::create(
      *model, {.width = 16, .height = 16, .software_quality = RenderQuality::low});
  if (!renderer) GTEST_SKIP() << renderer.error().what;
  const bool software = renderer->gl().is_software();
  EXPECT_EQ(renderer->quality(), software ? RenderQuality::low : RenderQuality::high);
}

/// [m] How far the shadow map of `kShadow` reaches with its ball `x` [m] beside the light.
double reach_with(const std::string& x, bool software) {
  std::string mjcf = kShadow;
  const std::string place = "pos=\"0 0 1.2\"";
  mjcf.replace(mjcf.find(place), place.size(), "pos=\"" + x + " 0 1.2\"");
  const Result<Model> model = load_mjcf(mjcf.c_str());
  EXPECT_TRUE(model) << model.error().what;
  Scene scene(*model, RenderQuality::medium, software);
  Overlay overlay;  // casts no shadow
  overlay.spheres.push_back({.p_W = {-1.9, 0, 1}});
  scene.update(overlay);
  return scene.shadow_reach();
}

TEST(Shadows, ReachAsFarAsWhatCastsThem) {
  // The model asks for 2 m each way on 4096 cells; the processor gets 1024.
  EXPECT_NEAR(reach_with("0", true), 0.5, 1e-6) << "as fine as asked for";
  EXPECT_GT(reach_with("1", true), 1.3);
  EXPECT_LT(reach_with("1", true), 1.35);
  EXPECT_NEAR(reach_with("5", true), 2, 1e-6);
  EXPECT_NEAR(reach_with("1", false), 2, 1e-6);
}

/// The state after every step of a second in which two servos swing and the arm falls on the floor.
/// @param looks  called after every step.
std::vector<Snapshot> swing_arm(const Model& model, const std::function<void(const Sim&)>& looks) {
  Sim sim(model);
  std::vector<Snapshot> states;
  for (int i = 0; i < 500; ++i) {
    const double phase = 0.02 * i;
    const std::vector<double> ctrl = {1.2 * std::sin(phase), 0.8 * std::cos(phase)};
    EXPECT_TRUE(sim.step(ctrl));
    looks(sim);
    states.push_back(sim.snapshot());
  }
  return states;
}

TEST(Looking, ChangesNoBitOfTheSimulation) {
  const Result<Model> model = load_mjcf(kArm);
  ASSERT_TRUE(model) << model.error().what;
  Result<OffscreenRenderer> renderer =
      OffscreenRenderer::create(*model, {.width = 64, .height = 48});
  if (!renderer) GTEST_SKIP() << renderer.error().what;
  Overlay overlay;
  overlay.lines.emplace_back();
  std::vector<Image> frames;
  const std::vector<Snapshot> seen = swing_arm(*model, [&](const Sim& sim) {
    overlay.lines.front().points_W.push_back({sim.time(), 0, 1});
    if (std::lround(sim.time() / 0.002) % 10 != 0) return;
    const Result<Image> image = renderer->draw(sim.snapshot(), {}, overlay);
    ASSERT_TRUE(image) << image.error().what;
    frames.push_back(*image);
  });
  const std::vector<Snapshot> alone = swing_arm(*model, [](const Sim&) {});
  ASSERT_EQ(frames.size(), 50U);
  EXPECT_NE(frames.front().rgb, frames.back().rgb);
  ASSERT_EQ(seen.size(), alone.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ASSERT_EQ(seen[i].time, alone[i].time);
    ASSERT_EQ(seen[i].state, alone[i].state) << "step " << i;
  }
}

TEST(GlBackends, NeedNoDisplay) {
  const std::vector<GlBackend> before = probe_gl_backends();
  const std::optional<std::string> display = environment("DISPLAY");
  ::setenv("DISPLAY", ":4711", 1);  // announced, but nobody there
  const std::vector<GlBackend> nobody = probe_gl_backends();
  ::unsetenv("DISPLAY");
  const std::vector<GlBackend> none = probe_gl_backends();
  if (display) ::setenv("DISPLAY", display->c_str(), 1);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(nobody[i].works, before[i].works) << nobody[i].reason;
    EXPECT_EQ(none[i].works, before[i].works) << none[i].reason;
  }
}

}  // namespace
}  // namespace mjarm::render
