// Pages as pixels and as SVG: both must show the same, in any size that can be drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "mjarm/core/rng.hpp"
#include "mjarm/render/canvas_internal.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/render/svg_reader_test.hpp"

namespace mjarm::canvas {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
using mjarm::testing::SvgReader;

constexpr render::Rgba kBlack = {0, 0, 0, 1};
constexpr render::Rgba kRed = {1, 0, 0, 1};

render::Image painted(const Page& page, double scale = 1) { return to_image(page, scale).value(); }

/// Number of pixels that are not white.
int inked(const render::Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) count += image.pixel(x, y) != Rgb{255, 255, 255} ? 1 : 0;
  }
  return count;
}

/// Columns of the leftmost and the rightmost pixel that is not white; {width, -1} for none.
std::pair<int, int> inked_columns(const render::Image& image) {
  std::pair<int, int> out{image.width, -1};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.pixel(x, y) == Rgb{255, 255, 255}) continue;
      out = {std::min(out.first, x), std::max(out.second, x)};
    }
  }
  return out;
}

TEST(Canvas, FillsCoverExactlyTheirBoxInTheOrderGiven) {
  Page page{20, 10, {}};
  page.items = {Fill{{2, 3, 5, 4}, kRed}, Fill{{4, 4, 10, 2}, {0, 0, 1, 1}}};
  for (const int scale : {1, 2, 3}) {
    const render::Image image = painted(page, scale);
    ASSERT_EQ(image.width, 20 * scale);
    ASSERT_EQ(image.height, 10 * scale);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const double px = (x + 0.5) / scale, py = (y + 0.5) / scale;
        const bool blue = px > 4 && px < 14 && py > 4 && py < 6;
        const bool red = px > 2 && px < 7 && py > 3 && py < 7;
        const Rgb expected = blue ? Rgb{0, 0, 255} : red ? Rgb{255, 0, 0} : Rgb{255, 255, 255};
        ASSERT_EQ(image.pixel(x, y), expected) << x << " " << y << " " << scale;
      }
    }
  }
}

TEST(Canvas, OpacityMixesWithWhatIsBehind) {
  for (const float alpha : {0.0F, 0.25F, 0.5F, 1.0F}) {
    Page page{4, 4, {}};
    page.items = {Fill{{0, 0, 4, 4}, kRed}, Fill{{0, 0, 4, 4}, {0, 0, 1, alpha}}};
    const auto [r, g, b] = painted(page).pixel(1, 1);
    EXPECT_NEAR(r, 255 * (1 - alpha), 1.5);
    EXPECT_EQ(g, 0);
    EXPECT_NEAR(b, 255 * alpha, 1.5);
    const auto svg = SvgReader::read(to_svg(page));
    ASSERT_EQ(svg.size(), 3U);
    EXPECT_EQ(svg[1].attributes.contains("fill-opacity"), false);
    EXPECT_EQ(svg[2].attributes.contains("fill-opacity"), alpha < 1);
    if (alpha < 1) {
      EXPECT_NEAR(svg[2].number("fill-opacity"), alpha, 0.005);
    }
  }
}

TEST(Canvas, ClipsEndWhereTheyAreUndone) {
  Page page{12, 4, {}};
  page.items = {Clip{{2, 0, 3, 4}}, Fill{{0, 0, 12, 4}, kBlack}, Unclip{},
                Fill{{8, 0, 2, 4}, kRed}};
  const render::Image image = painted(page);
  std::string row;
  for (int x = 0; x < 12; ++x) {
    const Rgb pixel = image.pixel(x, 2);
    row += pixel == Rgb{0, 0, 0} ? 'k' : pixel == Rgb{255, 0, 0} ? 'r' : '.';
  }
  EXPECT_EQ(row, "..kkk...rr..");
  page.items.insert(page.items.end(), {Clip{{0, 0, 1, 1}}, Unclip{}});
  std::vector<std::string> ids, used;
  for (const auto& element : SvgReader::read(to_svg(page))) {
    if (element.name == "clipPath") ids.push_back(element.attributes.at("id"));
    if (element.name == "g") used.push_back(element.attributes.at("clip-path"));
  }
  EXPECT_THAT(ids, ::testing::ElementsAre("clip1", "clip2")) << "no two of the same name";
  EXPECT_THAT(used, ::testing::ElementsAre("url(#clip1)", "url(#clip2)"));
}

/// A dashed line is ink for as much of its length as its dashes say.
TEST(Canvas, DashesAreTheirShareOfTheLine) {
  const auto ink_of = [](std::vector<double> dash) {
    Page page{220, 6, {}};
    page.items = {Polyline{{{10, 3}, {210, 3}}, {kBlack, 2, std::move(dash)}}};
    return inked(painted(page));
  };
  const int whole = ink_of({});
  EXPECT_NEAR(whole, 400, 4);
  EXPECT_NEAR(ink_of({5, 5}), whole / 2.0, 10);
  EXPECT_NEAR(ink_of({6, 2}), whole * 0.75, 12);
  Page nothing{20, 20, {}};
  nothing.items = {Polyline{}, Dots{}, Text{}};
  EXPECT_EQ(inked(painted(nothing)), 0);
  SvgReader::read(to_svg(nothing));
}

TEST(Canvas, DotsHaveTheirAreaAndPlace) {
  Page page{60, 30, {}};
  page.items = {Dots{{{15, 15}, {45, 15}}, 10, kBlack}};
  const render::Image image = painted(page, 4);
  double area = 0, mean_x = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double ink = (255 - image.pixel(x, y)[0]) / 255.0;
      area += ink / 16;
      mean_x += ink / 16 * (x + 0.5) / 4;
    }
  }
  EXPECT_NEAR(area, 2 * M_PI * 100, 3);
  EXPECT_NEAR(mean_x / area, 30, 0.01);
}

/// Texts stand left of, around and right of their point, and are as wide as they are said to be.
TEST(Canvas, TextsAreAlignedByTheirWidth) {
  for (const char* text : {"MMMMMMMM", "0.25", "误差（毫米）", "a误b差c"}) {
    TextStyle style{.size = 10, .color = kBlack};
    const double width = text_width(text, style);
    EXPECT_GT(width, 10);
    for (const Align align : {Align::left, Align::middle, Align::right}) {
      style.align = align;
      Page page{300, 30, {}};
      page.items = {Text{{150, 20}, text, style}};
      const auto [left, right] = inked_columns(painted(page, 2));
      const double begin = align == Align::left     ? 150
                           : align == Align::middle ? 150 - width / 2
                                                    : 150 - width;
      ASSERT_GE(right, 0) << text;
      EXPECT_GE(left / 2.0, begin - 1) << text;
      EXPECT_LE(right / 2.0, begin + width + 1) << text;
      EXPECT_GT((right - left) / 2.0, 0.75 * width) << text;
    }
  }
}

TEST(Canvas, UprightTextsRunUpwards) {
  TextStyle style{.size = 10, .upright = true, .color = kBlack};
  Page page{60, 200, {}};
  page.items = {Text{{30, 150}, "WWWWWW", style}};
  const render::Image image = painted(page);
  style.upright = false;
  const double width = text_width("WWWWWW", style);
  int top = image.height, bottom = -1;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.pixel(x, y) == Rgb{255, 255, 255}) continue;
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  EXPECT_NEAR(top, 150 - width, 2);
  EXPECT_NEAR(bottom, 150, 2);
  const auto svg = SvgReader::read(to_svg(page));
  EXPECT_EQ(svg.back().attributes.at("transform"), "rotate(-90 30 150)");
}

TEST(Canvas, WidthsGrowWithTheTextAndItsSize) {
  const TextStyle style{.size = 8};
  EXPECT_EQ(text_width("", style), 0);
  double before = 0;
  for (const char* text : {"i", "in", "inn", "inn 中", "inn 中文"}) {
    EXPECT_GT(text_width(text, style), before) << text;
    before = text_width(text, style);
  }
  EXPECT_NEAR(text_width("abc 0.5", {.size = 16}) / text_width("abc 0.5", style), 2, 0.05);
  EXPECT_GT(text_width("abc", {.size = 8, .bold = true}), text_width("abc", style));
  // What is no UTF-8 is mended and has a width of its own.
  EXPECT_GT(text_width("\xFF\xFE", style), 0);
}

/// Whatever is in the text, the file stays well-formed and says the same once it is read.
TEST(Canvas, AnyBytesGiveAWellFormedFile) {
  Rng rng(8);
  for (int round = 0; round < 300; ++round) {
    std::string text;
    const auto length = rng.below(12);
    for (std::uint64_t i = 0; i < length; ++i) text += static_cast<char>(rng.below(256));
    Page page{10, 10, {}};
    page.items = {Text{{1, 1}, text, {}}, Text{{1, 1}, "end", {}}};
    const auto svg = SvgReader::read(to_svg(page));
    ASSERT_EQ(svg.size(), 3U);
    EXPECT_EQ(svg[2].text, "end");
    std::string kept;
    for (const canvas::Run& run : runs_of(text)) {
      for (const char c : run.text) {
        if (static_cast<unsigned char>(c) >= 32) kept += c;
      }
    }
    EXPECT_EQ(svg[1].text, kept);
  }
}

/// Runs hold all of the text in order, no two neighbours of one font.
TEST(Canvas, RunsOfAnyBytesAreWholeAndAlternate) {
  Rng rng(9);
  const char* parts[] = {"a", "é", "误", "（", "😀", "\xFF", "\xE8\xAF", "한", "×"};
  for (int round = 0; round < 500; ++round) {
    std::string text, expected;
    const auto length = rng.below(20);
    for (std::uint64_t i = 0; i < length; ++i) {
      const auto k = rng.below(9);
      text += parts[k];
      // A cut character is mended byte by byte, and the letter after it is none of it.
      expected += k == 5 ? "\xEF\xBF\xBD" : k == 6 ? "\xEF\xBF\xBD\xEF\xBF\xBD" : parts[k];
    }
    std::string joined;
    const std::vector<canvas::Run> runs = runs_of(text);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      EXPECT_FALSE(runs[i].text.empty());
      if (i > 0) {
        EXPECT_NE(runs[i].cjk, runs[i - 1].cjk);
      }
      joined += runs[i].text;
    }
    ASSERT_EQ(joined, expected);
  }
}

/// More pixels than a picture can have are refused with one line, and nothing is drawn in none.
TEST(Canvas, PicturesThatCannotBeAreRefused) {
  const render::Plot plot{.panels = {{}}, .columns = 1};
  for (const double scale : {200.0, 1e6, -1.0}) {
    const Result<render::Image> image = render::plot_image(plot, scale);
    ASSERT_FALSE(image) << scale;
    EXPECT_THAT(image.error().what, ::testing::StartsWith("the plot could not be drawn: "));
    EXPECT_EQ(image.error().what.find('\n'), std::string::npos);
  }
  for (const double scale : {0.37, 1.0, 3.3}) {
    const render::Image image = render::plot_image(plot, scale).value();
    EXPECT_EQ(image.width, std::lround(286 * scale));
    EXPECT_EQ(image.height, std::lround(216 * scale));
    EXPECT_EQ(image.rgb.size(), std::size_t{3} * image.width * image.height);
  }
}

}  // namespace
}  // namespace mjarm::canvas
