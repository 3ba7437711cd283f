// Text that MuJoCo's own font has no letters for, drawn into a picture without a window.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cstdlib>
#include <optional>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/render/gl_context.hpp"
#include "mjarm/view/figure_internal.hpp"
#include "mjarm/view/gl_function_test.hpp"
#include "mjarm/view/glyph_font_internal.hpp"
#include "mjarm/view/hud_internal.hpp"
#include "mjarm/view/ui_column_internal.hpp"

namespace mjarm::view {
namespace {

constexpr int kWide = 640;
constexpr int kHigh = 480;
constexpr float kWhite[3] = {1, 1, 1};

class Lettering : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("MUJOCO_GL");
    if (render::chinese_font().empty()) GTEST_SKIP() << "no Chinese font (fonts-wqy-microhei)";
    Result<render::GlContext> made = render::GlContext::create();
    if (!made) GTEST_SKIP() << made.error().what;
    gl_.emplace(std::move(*made));
    mjr_defaultContext(&context_);
    ASSERT_FALSE(
        call_mujoco([&] { mjr_makeContext(&scene_.model(), &context_, mjFONTSCALE_100); }).failed);
    mjr_resizeOffscreen(kWide, kHigh, &context_);
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
    font_.emplace(context_.charHeight, testing::gl_function);
    clear();
  }
  void TearDown() override {
    if (gl_) mjr_freeContext(&context_);
  }
  void clear() { mjr_rectangle({0, 0, kWide, kHigh}, 0, 0, 0, 1); }
  [[nodiscard]] TextTools tools() { return {context_, *font_, {0, 0, kWide, kHigh}}; }
  /// How much light there is in a part of the picture, in pixels.
  double light(int left, int bottom, int width, int height) {
    std::vector<unsigned char> rgb(3 * static_cast<std::size_t>(width) * height);
    mjr_readPixels(rgb.data(), nullptr, {left, bottom, width, height}, &context_);
    double sum = 0;
    for (const unsigned char value : rgb) sum += value / 255.0;
    return sum / 3;
  }

  Model model_ =
      Model::from_mjcf("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>").value();
  render::Scene scene_{model_, render::RenderQuality::low};
  std::optional<render::GlContext> gl_;
  mjrContext context_{};
  std::optional<GlyphFont> font_;
};

TEST_F(Lettering, WidthsAreThoseOfFullWidthLetters) {
  const int one = font_->width("关");
  EXPECT_NEAR(one, context_.charHeight, 0.25 * context_.charHeight);
  EXPECT_EQ(font_->width("关节误差"), 4 * one);
  EXPECT_GT(font_->width("关 a"), one);
  EXPECT_LT(font_->width("ab"), 2 * one);
  EXPECT_EQ(font_->width(""), 0);
}

TEST_F(Lettering, IsDrawnInItsPlaceAndNowhereElse) {
  const PixelBox box{100, 200, 300, 24};
  font_->draw("关节误差", {0, 0, kWide, kHigh}, box, kWhite, 300);
  const int width = font_->width("关节误差");
  EXPECT_GT(light(100, 200, width, 24), 40);
  EXPECT_NEAR(light(0, 0, kWide, kHigh), light(98, 200, width + 4, 24), 1);
  clear();
  font_->draw("关节误差", {0, 0, kWide, kHigh}, box, kWhite, width / 2);
  EXPECT_GT(light(100, 200, width / 2, 24), 20);
  EXPECT_NEAR(light(100 + width / 2 + 2, 200, width, 24), 0, 1) << "what is too long is left out";
}

/// More letters than the texture holds: it begins anew, and what is drawn then is as before.
TEST_F(Lettering, AnyNumberOfLettersIsDrawn) {
  const PixelBox window{0, 0, kWide, kHigh}, box{10, 10, 600, 24};
  font_->draw("关", window, box, kWhite, 600);
  const double before = light(0, 0, kWide, kHigh);
  for (int code = 0x4E00; code < 0x4E00 + 2500; ++code) {
    const char letter[] = {static_cast<char>(0xE0 | (code >> 12)),
                           static_cast<char>(0x80 | ((code >> 6) & 0x3F)),
                           static_cast<char>(0x80 | (code & 0x3F)), 0};
    font_->draw(letter, window, box, kWhite, 600);
  }
  clear();
  font_->draw("关", window, box, kWhite, 600);
  EXPECT_NEAR(light(0, 0, kWide, kHigh), before, 1e-9);
}

/// Every text of a panel that is not ASCII stands where MuJoCo would have put it.
TEST_F(Lettering, PanelsShowChineseInEachKindOfItem) {
  mjuiState state{};
  state.nrect = 2;
  state.rect[0] = {0, 0, kWide, kHigh};
  state.rect[1] = {0, 0, 300, kHigh};
  const auto light_of = [&](const std::string& word) {
    std::vector<double> out;
    UiColumn column(1);
    const std::vector<PanelSection> sections = {{word,
                                                 {{1, word, PanelButton{}},
                                                  {2, word, PanelCheckbox{}},
                                                  {3, word, PanelText{word}},
                                                  {4, word, PanelChoice{{word, word}, 1}},
                                                  {5, word, PanelSlider{0, 0, 1}},
                                                  {6, "", PanelList{{word, word, word}, 1}}}}};
    column.show(sections, state, context_);
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
    clear();
    column.render(state, context_, *font_);
    for (int i = -1; i < 6; ++i) {
      const mjrRect place = column.place(0, i, state).value();
      const bool labelled = i >= 2 && i < 5;
      out.push_back(light(place.left, place.bottom, place.width, place.height));
      if (labelled) out.push_back(light(20, place.bottom, place.left - 25, place.height));
    }
    return out;
  };
  const std::vector<double> blank = light_of(" "), chinese = light_of("关节误差"),
                            english = light_of("joints");
  ASSERT_EQ(blank.size(), 10U);
  for (std::size_t i = 0; i < blank.size(); ++i) {
    if (i == 7) continue;  // the slider itself
    EXPECT_GT(english[i] - blank[i], 10) << i;
    EXPECT_GT(chinese[i] - blank[i], 20) << i;
  }
}

TEST_F(Lettering, TheLinesOverThePictureAreChinese) {
  const mjrRect view{0, 0, kWide, kHigh};
  const auto light_at_the_foot = [&](const std::string& status) {
    clear();
    draw_hud({.status = status}, view, tools());
    return light(0, 0, kWide, 3 * tools().line());
  };
  EXPECT_GT(light_at_the_foot("误差 1.25 mm"), light_at_the_foot("1.25 mm") + 30);
  const LanguageScope chinese(Language::chinese);
  clear();
  draw_hud({.help = true}, view, tools());
  EXPECT_GT(light(0, 0, kWide, kHigh), 2000);
}

/// The title and the axis of a figure; its legend where a name is not ASCII.
TEST_F(Lettering, FiguresAreChineseToo) {
  const auto figure = std::make_unique<mjvFigure>();
  const auto light_of = [&](const std::string& word) {
    LivePlot plot{.title = word, .x_label = word};
    plot.series = {{.name = word, .color = {1, 1, 1, 1}, .x = {0, 1}, .y = {0, 0.01}}};
    fill_figure(plot, *figure);
    clear();
    draw_figure(plot, *figure, {0, 0, 300, 300}, tools());
    return std::vector<double>{light(60, 275, 180, 25), light(100, 0, 100, 22),
                               light(180, 180, 120, 90)};
  };
  const std::vector<double> english = light_of("error"), chinese = light_of("误差误差");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(english[i], 10) << i;
    EXPECT_GT(chinese[i], 10) << i;
  }
}

}  // namespace
}  // namespace mjarm::view
