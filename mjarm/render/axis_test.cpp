#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/render/axis_internal.hpp"

namespace mjarm::axis {
namespace {

using Labels = std::vector<std::string>;

TEST(Ticks, AreRoundNumbers) {
  EXPECT_EQ(ticks_for({0, 10}, 5).labels, (Labels{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(ticks_for({-0.31, 0.31}, 6).labels, (Labels{"\u22120.2", "0.0", "0.2"}));
  EXPECT_EQ(ticks_for({0, 1}, 2).labels, (Labels{"0.0", "0.5", "1.0"}));
}

TEST(Ticks, SmallAndLargeNumbersShareAFactor) {
  const Ticks small = ticks_for({0, 2.5e-4}, 5);
  EXPECT_EQ(small.factor, "\u00D710\u207B\u2076");
  EXPECT_EQ(small.labels, (Labels{"0", "50", "100", "150", "200", "250"}));
  const Ticks large = ticks_for({0, 3e6}, 3);
  EXPECT_EQ(large.factor, "\u00D710\u2076");
  EXPECT_EQ(large.labels, (Labels{"0", "1", "2", "3"}));
  EXPECT_EQ(ticks_for({0, 0.5}, 5).factor, "");
}

/// What a label says, without its factor.
double value_of(std::string label) {
  if (label.rfind("\u2212", 0) == 0) label.replace(0, 3, "-");
  return std::stod(label);
}

TEST(Ticks, OfRandomRangesAreInsideEvenAndSayWhatTheyAre) {
  Rng rng(11);
  for (int i = 0; i < 5000; ++i) {
    const double length = std::pow(10.0, rng.uniform(-9, 9));
    const double lower = length * rng.uniform(-30, 30);
    const render::PlotRange range = {lower, lower + length};
    const int count = 2 + static_cast<int>(rng.uniform(0, 8));
    const Ticks ticks = ticks_for(range, count);
    ASSERT_EQ(ticks.at.size(), ticks.labels.size());
    ASSERT_LE(ticks.at.size(), static_cast<std::size_t>(count + 1));
    double factor = 0;
    for (std::size_t k = 0; k < ticks.at.size(); ++k) {
      ASSERT_GE(ticks.at[k], range.lower - 1e-6 * length);
      ASSERT_LE(ticks.at[k], range.upper + 1e-6 * length);
      if (k > 1) {
        ASSERT_NEAR(ticks.at[k] - ticks.at[k - 1], ticks.at[1] - ticks.at[0], 1e-6 * length);
      }
      // Labels and places differ by one factor, a power of a thousand.
      const double said = value_of(ticks.labels[k]);
      if (said == 0) {
        ASSERT_NEAR(ticks.at[k], 0, 1e-6 * length);
      } else if (factor == 0) {
        factor = ticks.at[k] / said;
        ASSERT_NEAR(std::log10(factor) / 3, std::round(std::log10(factor) / 3), 1e-6);
        ASSERT_EQ(ticks.factor.empty(), std::abs(factor - 1) < 1e-6);
      } else {
        ASSERT_NEAR(ticks.at[k], said * factor, 1e-6 * length);
      }
    }
  }
}

TEST(Extent, ShowsAllThatIsFinite) {
  Extent extent;
  for (const double value : {1.0, std::nan(""), 3.0, std::numeric_limits<double>::infinity()}) {
    extent.add(value);
  }
  const render::PlotRange range = extent.range(0.1);
  EXPECT_NEAR(range.lower, 0.8, 1e-12);
  EXPECT_NEAR(range.upper, 3.2, 1e-12);
}

TEST(Extent, OfOneValueOrNoneCanBeDrawn) {
  const render::PlotRange none = Extent().range(0.1);
  EXPECT_LT(none.lower, none.upper);
  for (const double value : {0.0, 1.5, -3e5, 1e-12}) {
    Extent extent;
    extent.add(value);
    extent.add(value * (1 + 1e-15));
    const render::PlotRange range = extent.range(0);
    EXPECT_LT(range.lower, value);
    EXPECT_GT(range.upper, value);
  }
}

TEST(Equalise, GivesBothAxesOneUnitAndHidesNothing) {
  Rng rng(5);
  for (int i = 0; i < 1000; ++i) {
    const render::PlotRange x0 = {rng.uniform(-2, 0), rng.uniform(0.1, 2)};
    const render::PlotRange y0 = {rng.uniform(-2, 0), rng.uniform(0.1, 2)};
    const double width = rng.uniform(50, 300);
    const double height = rng.uniform(50, 300);
    render::PlotRange x = x0;
    render::PlotRange y = y0;
    equalise(x, y, width, height);
    ASSERT_NEAR((x.upper - x.lower) / width, (y.upper - y.lower) / height, 1e-12);
    ASSERT_LE(x.lower, x0.lower + 1e-12);
    ASSERT_GE(x.upper, x0.upper - 1e-12);
    ASSERT_LE(y.lower, y0.lower + 1e-12);
    ASSERT_GE(y.upper, y0.upper - 1e-12);
  }
}

}  // namespace
}  // namespace mjarm::axis
