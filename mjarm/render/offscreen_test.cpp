#include "mjarm/render/offscreen.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "tests/support/temp_folder.hpp"

namespace mjarm::render {
namespace {

/// A camera on -y that looks along +y: x runs to the right, z upwards, one metre in the middle is a
/// third of the picture's height. No light but the even one round the camera.
constexpr const char* kBalls = R"(
<mujoco model="balls">
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <statistic center="0 0 0" extent="2"/>
  <worldbody>
    <camera name="front" pos="0 -3 0" xyaxes="1 0 0 0 0 1" fovy="53.13"/>
    <camera name="back" pos="0 3 0" xyaxes="-1 0 0 0 0 1" fovy="53.13"/>
    <geom type="sphere" size="0.3" pos="-1 0 0" rgba="1 0 0 1"/>
    <body pos="1 0 0">
      <joint name="lift" type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.3" rgba="0 0 1 1"/>
    </body>
  </worldbody>
</mujoco>)";

constexpr int kWidth = 300;
constexpr int kHeight = 200;
const Camera kFront = {.name = "front"};

enum class Color { red, green, blue, black, other };

Color color_at(const Image& image, int x, int y) {
  const auto [r, g, b] = image.pixel(x, y);
  const int high = 120;
  const int low = 60;
  if (r > high && g < low && b < low) return Color::red;
  if (g > high && r < low && b < low) return Color::green;
  if (b > high && r < low && g < low) return Color::blue;
  if (r < low && g < low && b < low) return Color::black;
  return Color::other;
}

/// Column and row where a point of the plane y = 0 is seen by the camera `front`.
int column_of(double x) { return kWidth / 2 + static_cast<int>(x * kHeight / 3); }
int row_of(double z) { return kHeight / 2 - static_cast<int>(z * kHeight / 3); }

class Offscreen : public ::testing::TestWithParam<GlChoice> {
 protected:
  void SetUp() override {
    unsetenv("MUJOCO_GL");
    Result<Model> loaded = Model::load(folder_.write("balls.xml", kBalls));
    ASSERT_TRUE(loaded) << loaded.error().what;
    model_ = std::make_unique<Model>(*loaded);
    Result<OffscreenRenderer> made = OffscreenRenderer::create(
        *model_,
        {.width = kWidth, .height = kHeight, .quality = RenderQuality::low, .gl = GetParam()});
    if (!made) {
      const bool osmesa = GetParam() == GlChoice::osmesa;
      const bool works = probe_gl_backends()[osmesa ? 1 : 0].works;
      const bool other_draws = !claim_gl(osmesa ? GlKind::osmesa : GlKind::egl);
      ASSERT_TRUE(!works || other_draws) << made.error().what;
      GTEST_SKIP() << made.error().what;
    }
    renderer_ = std::make_unique<OffscreenRenderer>(std::move(*made));
  }

  Image picture(const Snapshot& snapshot = {}, const Camera& camera = kFront,
                const Overlay& overlay = {}) {
    Result<Image> image = renderer_->draw(snapshot, camera, overlay);
    if (image) return *image;
    ADD_FAILURE() << image.error().what;
    return {1, 1, {0, 0, 0}};
  }

  /// The model with its slide joint at `lift` [m].
  Snapshot lifted(double lift) const {
    const mjModel* m = model_->raw();
    const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
    d->qpos[0] = lift;
    Snapshot snapshot;
    snapshot.state.resize(static_cast<std::size_t>(mj_stateSize(m, mjSTATE_INTEGRATION)));
    mj_getState(m, d.get(), snapshot.state.data(), mjSTATE_INTEGRATION);
    return snapshot;
  }

  support::TempFolder folder_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<OffscreenRenderer> renderer_;
};

TEST_P(Offscreen, ShowsTheModelWhereItIs) {
  const Image image = picture();
  ASSERT_EQ(image.width, kWidth);
  ASSERT_EQ(image.height, kHeight);
  ASSERT_EQ(image.rgb.size(), std::size_t{3} * kWidth * kHeight);
  EXPECT_EQ(color_at(image, column_of(-1), row_of(0)), Color::red);
  EXPECT_EQ(color_at(image, column_of(1), row_of(0)), Color::blue);
  EXPECT_EQ(color_at(image, column_of(0), row_of(0)), Color::black);
  // The balls end where they should: 0.3 m to either side, seen a little larger.
  EXPECT_EQ(color_at(image, column_of(-1 + 0.25), row_of(0)), Color::red);
  EXPECT_EQ(color_at(image, column_of(-1 + 0.40), row_of(0)), Color::black);
  EXPECT_EQ(color_at(image, column_of(-1), row_of(0.25)), Color::red);
  EXPECT_EQ(color_at(image, column_of(-1), row_of(0.40)), Color::black);
}

TEST_P(Offscreen, ShowsTheStateOfTheSnapshotWithRowsFromTheTop) {
  const Image image = picture(lifted(0.9));
  EXPECT_EQ(color_at(image, column_of(1), row_of(0.9)), Color::blue);
  EXPECT_LT(row_of(0.9), kHeight / 2);
  EXPECT_EQ(color_at(image, column_of(1), row_of(0)), Color::black);
  // A snapshot without state is the model as it starts, also after another one.
  EXPECT_EQ(color_at(picture(), column_of(1), row_of(0)), Color::blue);
}

TEST_P(Offscreen, UsesTheCameraAskedFor) {
  const Image back = picture({}, {.name = "back"});
  EXPECT_EQ(color_at(back, column_of(1), row_of(0)), Color::red);
  EXPECT_EQ(color_at(back, column_of(-1), row_of(0)), Color::blue);
  // A free camera in the same place: azimuth 90 degrees looks along +y.
  const CameraView view = {.distance = 3, .azimuth = 1.5707963267948966};
  const Image free = picture({}, {.view = view});
  EXPECT_EQ(color_at(free, kWidth / 2 - 70, row_of(0)), Color::red);
  EXPECT_EQ(color_at(free, kWidth / 2 + 70, row_of(0)), Color::blue);
}

TEST_P(Offscreen, DrawsTheOverlayOnTop) {
  const Rgba green = {0, 1, 0, 1};
  Overlay overlay;
  overlay.spheres.push_back({{0, 0, 0.5}, 0.2, green});
  overlay.lines.push_back({{{-0.5, 0, -0.8}, {0, 0, -0.8}, {0.5, 0, -0.8}}, 0.2, green});
  overlay.arrows.push_back({{0, 0, -0.5}, {0.5, 0, -0.5}, 0.2, green});
  const Image before = picture();
  const Image image = picture({}, kFront, overlay);
  for (const auto& [x, z] :
       {std::pair(0.0, 0.5), std::pair(-0.4, -0.8), std::pair(0.4, -0.8), std::pair(0.1, -0.5)}) {
    EXPECT_EQ(color_at(before, column_of(x), row_of(z)), Color::black) << x << " " << z;
    EXPECT_EQ(color_at(image, column_of(x), row_of(z)), Color::green) << x << " " << z;
  }
  // The arrow ends at its point.
  EXPECT_EQ(color_at(image, column_of(0.42), row_of(-0.5)), Color::green);
  EXPECT_NE(color_at(image, column_of(0.55), row_of(-0.5)), Color::green);
  EXPECT_EQ(color_at(image, column_of(-1), row_of(0)), Color::red);
  EXPECT_EQ(picture().rgb, before.rgb) << "an overlay must not stay";
}

TEST_P(Offscreen, HoldsAnOverlayOfAnySize) {
  Overlay overlay;
  for (int i = 0; i < 6000; ++i) overlay.spheres.push_back({{0, 5, 0}, 0.001, {}});
  overlay.spheres.push_back({{0, 0, 0.5}, 0.2, {0, 1, 0, 1}});
  const Image image = picture({}, kFront, overlay);
  EXPECT_EQ(color_at(image, column_of(0), row_of(0.5)), Color::green);
}

TEST_P(Offscreen, FramesShowTheirAxesAndLabelsTheirText) {
  Overlay overlay;
  overlay.frames.push_back({.X_WF = {}, .length = 0.8, .width = 0.15});
  const Image frame = picture({}, kFront, overlay);
  const auto x_axis = frame.pixel(column_of(0.5), row_of(0));
  EXPECT_GT(x_axis[0], 2 * std::max(x_axis[1], x_axis[2]));
  const auto z_axis = frame.pixel(column_of(0), row_of(0.5));
  EXPECT_GT(z_axis[2], 3 * std::max(z_axis[0], z_axis[1]) / 2);
  Overlay labels;
  labels.labels.push_back({{0, 0, 0}, "tool \xE4\xB8\xAD" + std::string(300, 'x')});
  EXPECT_NE(picture({}, kFront, labels).rgb, picture().rgb);
}

TEST_P(Offscreen, GivesTheSamePictureTwice) {
  EXPECT_EQ(picture(lifted(0.2)).rgb, picture(lifted(0.2)).rgb);
  EXPECT_NE(picture(lifted(0.2)).rgb, picture(lifted(0.4)).rgb);
}

TEST_P(Offscreen, HighQualitySmoothsEdges) {
  Result<OffscreenRenderer> made =
      OffscreenRenderer::create(*model_, {.width = kWidth, .height = kHeight, .gl = GetParam()});
  ASSERT_TRUE(made) << made.error().what;
  const Result<Image> high = made->draw({}, kFront);
  ASSERT_TRUE(high) << high.error().what;
  EXPECT_EQ(color_at(*high, column_of(-1), row_of(0)), Color::red);
  const auto mixed = [](const Image& image) {
    int count = 0;
    for (int x = 0; x < kWidth; ++x) count += color_at(image, x, row_of(0.2)) == Color::other;
    for (int x = 0; x < kWidth; ++x) {
      const auto [r, g, b] = image.pixel(x, row_of(0.2));
      count += r > 60 && r < 120;
    }
    return count;
  };
  EXPECT_GE(mixed(*high), mixed(picture()));
  // Two renderers of one process do not get in each other's way.
  EXPECT_EQ(color_at(picture(), column_of(1), row_of(0)), Color::blue);
}

/// Each pixel is the mean of four of a picture twice as large; thin lines are as wide as without.
TEST_P(Offscreen, SupersamplingIsTheMeanOfALargerPicture) {
  const auto draw = [&](int scale, int supersampling, const Overlay& overlay) {
    return OffscreenRenderer::create(*model_, {.width = scale * kWidth,
                                               .height = scale * kHeight,
                                               .quality = RenderQuality::low,
                                               .gl = GetParam(),
                                               .supersampling = supersampling})
        .value()
        .draw({}, kFront, overlay)
        .value();
  };
  const Image large = draw(2, 1, {}), small = draw(1, 2, {});
  ASSERT_EQ(small.width, kWidth);
  ASSERT_EQ(small.height, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int sum = large.pixel(2 * x, 2 * y)[c] + large.pixel(2 * x + 1, 2 * y)[c] +
                        large.pixel(2 * x, 2 * y + 1)[c] + large.pixel(2 * x + 1, 2 * y + 1)[c];
        ASSERT_NEAR(small.pixel(x, y)[c], sum / 4.0, 0.51) << x << " " << y;
      }
    }
  }
  Overlay line;
  line.lines.push_back({.points_W = {{-2, -0.5, 1}, {2, -0.5, 1}},
                        .width = 0.006,
                        .color = {1, 1, 1, 1},
                        .look = LineLook::thin});
  const auto added = [](const Image& with, const Image& without) {
    double sum = 0;
    for (std::size_t i = 0; i < with.rgb.size(); ++i) sum += std::abs(with.rgb[i] - without.rgb[i]);
    return sum;
  };
  const double plain = added(draw(1, 1, line), draw(1, 1, {}));
  EXPECT_GT(plain, 1000);
  EXPECT_NEAR(added(draw(1, 2, line), small), plain, 0.25 * plain);
}

TEST_P(Offscreen, RefusesWhatDoesNotFit) {
  Snapshot other;
  other.state.resize(1000);
  EXPECT_EQ(renderer_->draw(other).error().code, Errc::bad_input);
  const Result<Image> unknown = renderer_->draw({}, {.name = "fornt"});
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Errc::bad_input);
  EXPECT_NE(unknown.error().what.find("\"front\""), std::string::npos) << unknown.error().what;
  EXPECT_FALSE(renderer_->draw({}, {.view = CameraView{.distance = 0}}));
  // And goes on afterwards.
  EXPECT_EQ(color_at(picture(), column_of(-1), row_of(0)), Color::red);
}

TEST_P(Offscreen, SaysWhatDraws) {
  EXPECT_FALSE(renderer_->gl().renderer().empty());
  EXPECT_FALSE(renderer_->gl().version().empty());
  const bool osmesa = renderer_->gl().kind() == GlKind::osmesa;
  EXPECT_EQ(osmesa, GetParam() == GlChoice::osmesa);
  EXPECT_TRUE(!osmesa || renderer_->gl().is_software());
}

std::string name_of(const ::testing::TestParamInfo<GlChoice>& info) {
  return info.param == GlChoice::egl ? "egl" : "osmesa";
}
INSTANTIATE_TEST_SUITE_P(Kinds, Offscreen, ::testing::Values(GlChoice::egl, GlChoice::osmesa),
                         name_of);

TEST(OffscreenOptions, RefusesSizesThatCannotBeDrawn) {
  const support::TempFolder folder;
  const Result<Model> model = Model::load(folder.write("balls.xml", kBalls));
  ASSERT_TRUE(model) << model.error().what;
  for (const auto& [width, height] : {std::pair(0, 10), std::pair(10, -1), std::pair(10, 100000)}) {
    const auto made = OffscreenRenderer::create(*model, {.width = width, .height = height});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, Errc::bad_input);
  }
}

TEST(OffscreenOptions, SaysTheSizeAndWhatIsAllowed) {
  const Result<Model> model = Model::from_mjcf(kBalls);
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(OffscreenRenderer::create(*model, {.width = 8193, .height = 1}).error().what,
            "a picture of 8193 x 1 pixels cannot be drawn (1 to 8192 each way)");
}

/// Rows of any length stand below each other: where they were padded, the picture would lean.
TEST(OffscreenSizes, OddOnesShowTheSameWorld) {
  unsetenv("MUJOCO_GL");
  const Result<Model> model = Model::from_mjcf(kBalls);
  ASSERT_TRUE(model) << model.error().what;
  for (const auto& [width, height] : {std::pair(301, 201), std::pair(303, 199), std::pair(1, 1),
                                      std::pair(5, 1), std::pair(1, 7)}) {
    Result<OffscreenRenderer> made = OffscreenRenderer::create(
        *model, {.width = width, .height = height, .quality = RenderQuality::low});
    if (!made) GTEST_SKIP() << made.error().what;
    const Result<Image> image = made->draw({}, kFront);
    ASSERT_TRUE(image) << image.error().what;
    ASSERT_EQ(image->width, width);
    ASSERT_EQ(image->height, height);
    ASSERT_EQ(image->rgb.size(), std::size_t{3} * width * height);
    EXPECT_EQ(color_at(*image, width / 2, height / 2), Color::black) << "between the balls";
    if (width < 100) continue;
    const double metre = height / 3.0;
    for (const double z : {-0.2, 0.0, 0.2}) {
      for (const auto& [x, color] : {std::pair(-1.0, Color::red), std::pair(1.0, Color::blue),
                                     std::pair(-1.2, Color::red), std::pair(0.8, Color::blue)}) {
        EXPECT_EQ(color_at(*image, width / 2 + static_cast<int>(x * metre),
                           height / 2 - static_cast<int>(z * metre)),
                  color)
            << width << " x " << height << " at " << x << ", " << z;
      }
    }
  }
}

TEST(GlBackends, AreTriedAndExplainThemselves) {
  const std::vector<GlBackend> found = probe_gl_backends();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].name, "EGL");
  EXPECT_EQ(found[1].name, "OSMesa");
  for (const GlBackend& backend : found) {
    EXPECT_EQ(backend.works, backend.reason.empty()) << backend.reason;
    EXPECT_EQ(backend.works, !backend.renderer.empty());
    EXPECT_NE(backend.works, backend.reason.find("apt-get install") != std::string::npos);
  }
}

TEST(GlBackends, OnlyOneKindDrawsInAProcess) {
  Result<GlContext> first = GlContext::create();
  if (!first) GTEST_SKIP() << first.error().what;
  const GlKind kind = first->kind();
  first->release();
  const GlChoice other = kind == GlKind::egl ? GlChoice::osmesa : GlChoice::egl;
  EXPECT_EQ(GlContext::create(other).error().code, Errc::not_available);
  EXPECT_TRUE(claim_gl(kind));
  EXPECT_FALSE(claim_gl(kind == GlKind::egl ? GlKind::osmesa : GlKind::egl));
  const Result<GlContext> again = GlContext::create();
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->kind(), kind);
}

}  // namespace
}  // namespace mjarm::render
