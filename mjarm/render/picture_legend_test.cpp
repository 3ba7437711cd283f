#include "mjarm/render/picture_legend.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace mjarm::render {
namespace {

Image grey(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height, 90)};
}

TEST(PictureLegend, HasEveryColourAndLeavesTheRestAlone) {
  const std::vector<LegendEntry> entries = {{{{1, 0, 0, 0.4F}, {0, 1, 0, 1}}, "way of the tool"},
                                            {{{0, 0, 1, 1}}, "goal"},
                                            {{}, "a remark"}};
  Image image = grey(640, 360);
  (void)add_legend(image, entries);
  int red = 0, green = 0, blue = 0, changed = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto rgb = image.pixel(x, y);
      red += rgb[0] > 200 && rgb[1] < 30 ? 1 : 0;
      green += rgb[1] > 200 && rgb[0] < 30 ? 1 : 0;
      blue += rgb[2] > 200 && rgb[0] < 30 ? 1 : 0;
      if (rgb[0] == 90 && rgb[1] == 90 && rgb[2] == 90) continue;
      ++changed;
      EXPECT_TRUE(x < 200 && y > 300) << x << " " << y;
    }
  }
  EXPECT_GT(red, 20);
  EXPECT_NEAR(red, green, 0.3 * red);
  EXPECT_NEAR(blue, red + green, 0.3 * blue) << "as wide as a scale";
  EXPECT_GT(changed, 3000);
  for (const auto& [width, height] : {std::pair(20, 360), {640, 5}}) {
    Image small = grey(width, height);
    (void)add_legend(small, entries);
    EXPECT_EQ(small.rgb, grey(width, height).rgb);
  }
}

/// The legend goes where nothing with a colour stands; in a film it stays where it is.
TEST(PictureLegend, GoesWhereItHidesLeast) {
  const std::vector<LegendEntry> entries = {{{{1, 0, 0, 1}}, "way of the tool"}};
  Image image = grey(640, 360);
  const auto paint = [&image](int from_x, int to_x, int from_y, int to_y) {
    for (int y = from_y; y < to_y; ++y) {
      for (int x = from_x; x < to_x; ++x) {
        image.rgb[3 * (static_cast<std::size_t>(y) * 640 + static_cast<std::size_t>(x))] = 250;
      }
    }
  };
  Image free = image;
  const Corner first = add_legend(free, entries);
  EXPECT_FALSE(first.right || first.top);
  paint(0, 640, 300, 360);  // along the lower edge
  paint(0, 100, 0, 60);     // and at the upper left
  Image crowded = image;
  const Corner there = add_legend(crowded, entries);
  EXPECT_TRUE(there.right && there.top);
  const Corner same = add_legend(image, entries, first);
  EXPECT_FALSE(same.right || same.top);
}

}  // namespace
}  // namespace mjarm::render
