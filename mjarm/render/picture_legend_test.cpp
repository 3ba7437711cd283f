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
  add_legend(image, entries);
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
    add_legend(small, entries);
    EXPECT_EQ(small.rgb, grey(width, height).rgb);
  }
}

}  // namespace
}  // namespace mjarm::render
