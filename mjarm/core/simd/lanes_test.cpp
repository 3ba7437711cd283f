// Lanes beside plain numbers: what each function does to one lane, whatever stands in the others.
#include "mjarm/core/simd/lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/simd/functions.hpp"

namespace mjarm::simd {
namespace {

using FloatLanes = std::array<float, kFloats>;
using DoubleLanes = std::array<double, kDoubles>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class V, class Lanes>
Lanes lanes_of(const V& v) {
  Lanes out{};
  store(out.data(), v);
  return out;
}
FloatLanes lanes(const Floats& v) { return lanes_of<Floats, FloatLanes>(v); }
DoubleLanes lanes(const Doubles& v) { return lanes_of<Doubles, DoubleLanes>(v); }

float tanh_of(float x) { return lanes(hyperbolic_tangent(splat(x)))[0]; }

TEST(Lanes, EachDoubleIsWorkedOutByItself) {
  Rng rng(31);
  for (int n = 0; n < 500; ++n) {
    DoubleLanes a{}, b{};
    for (int k = 0; k < kDoubles; ++k) {
      a[k] = rng.uniform(-1e3, 1e3);
      b[k] = rng.below(4) == 0 ? a[k] : rng.uniform(-1e3, 1e3);
    }
    const Doubles x = load(a.data()), y = load(b.data());
    const DoubleLanes low = lanes(smaller(x, y)), high = lanes(larger(x, y));
    const DoubleLanes chosen = lanes(select(x < y, x, splat(7.0)));
    const DoubleLanes root = lanes(square_root(x * x));
    for (int k = 0; k < kDoubles; ++k) {
      ASSERT_EQ(low[k], std::min(a[k], b[k]));
      ASSERT_EQ(high[k], std::max(a[k], b[k]));
      ASSERT_EQ(chosen[k], a[k] < b[k] ? a[k] : 7.0);
      ASSERT_EQ(root[k], std::sqrt(a[k] * a[k]));
    }
  }
}

TEST(Lanes, RootsOfFloatsAreRoundedRightAndSumsOfProductsRoundAtMostTwice) {
  Rng rng(32);
  for (int n = 0; n < 500; ++n) {
    FloatLanes a{}, b{}, c{};
    for (int k = 0; k < kFloats; ++k) {
      a[k] = static_cast<float>(rng.uniform(0, 1e4));
      b[k] = static_cast<float>(rng.uniform(-2, 2));
      c[k] = static_cast<float>(rng.uniform(-1e4, 1e4));
    }
    const FloatLanes root = lanes(square_root(load(a.data())));
    const FloatLanes sum = lanes(multiply_add(load(a.data()), load(b.data()), load(c.data())));
    for (int k = 0; k < kFloats; ++k) {
      ASSERT_EQ(root[k], std::sqrt(a[k]));
      const double product = static_cast<double>(a[k]) * b[k], exact = product + c[k];
      ASSERT_NEAR(sum[k], exact, 6e-8 * (std::abs(product) + std::abs(exact)));
    }
  }
  const FloatLanes bad = lanes(square_root(splat(-1.0F)));
  EXPECT_TRUE(std::isnan(bad[0]) && std::isnan(bad[kFloats - 1]));
}

TEST(Lanes, ALaneIsChosenByItsOwnBit) {
  for (int k = 0; k < kFloats; ++k) {
    FloatLanes a{};
    a.fill(1);
    a[k] = -1;
    const LaneBits bit = LaneBits{1} << k;
    EXPECT_EQ(less(load(a.data()), splat(0.0F)), bit);
    // What is taken out leaves nothing behind, not even where it is no number.
    a.fill(kNan);
    const FloatLanes without = lanes(zero_where(kAllLanes & ~bit, load(a.data())));
    for (int i = 0; i < kFloats; ++i) {
      EXPECT_EQ(std::isnan(without[i]), i == k) << i;
      if (i != k) {
        EXPECT_EQ(without[i], 0.0F) << i;
      }
    }
  }
  EXPECT_EQ(less(splat(0.0F), splat(-0.0F)), 0U);
  EXPECT_EQ(less(splat(-0.0F), splat(0.0F)), 0U);
  EXPECT_EQ(less(splat(-kInfinity), splat(kInfinity)), kAllLanes);
}

TEST(Lanes, BytesAreGatheredFromWhereTheirLaneSays) {
  std::vector<std::uint8_t> table(256 + 3);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<std::uint8_t>(255 - i % 256);
  Rng rng(33);
  for (int n = 0; n < 200; ++n) {
    std::array<std::int32_t, kFloats> index{};
    for (std::int32_t& i : index) i = static_cast<std::int32_t>(rng.below(256));
    const auto got =
        bits_as<std::array<std::int32_t, kFloats>>(gather(table.data(), bits_as<Ints>(index)));
    for (int k = 0; k < kFloats; ++k) ASSERT_EQ(got[k], 255 - index[k]);
  }
}

TEST(Lanes, QuadsStandSideBySideInTheirOrder) {
  std::array<Quad, kFloats / 4> quads{};
  for (int k = 0; k < kFloats; ++k) quads[k / 4][k % 4] = static_cast<float>(k);
  const FloatLanes all = lanes(joined(quads.data()));
  for (int k = 0; k < kFloats; ++k) EXPECT_EQ(all[k], static_cast<float>(k));
}

TEST(Lanes, SineAndCosineAreThoseOfTheCircle) {
  Rng rng(34);
  for (int n = 0; n < 2000; ++n) {
    DoubleLanes x{};
    for (double& value : x) value = rng.uniform(-1e4, 1e4);
    Doubles s, c, s_back, c_back;
    sine_cosine(load(x.data()), s, c);
    sine_cosine(-load(x.data()), s_back, c_back);
    const DoubleLanes one = lanes(s * s + c * c), sum = lanes(s + s_back), gap = lanes(c - c_back);
    for (int k = 0; k < kDoubles; ++k) {
      ASSERT_NEAR(one[k], 1, 1e-15) << x[k];
      ASSERT_EQ(sum[k], 0) << x[k];  // odd and even to the last bit
      ASSERT_EQ(gap[k], 0) << x[k];
    }
  }
  Floats s, c;
  sine_cosine(splat(0.0F), s, c);
  EXPECT_EQ(lanes(s)[0], 0.0F);
  EXPECT_EQ(lanes(c)[kFloats - 1], 1.0F);
  // At every quarter turn, where the branch changes, and next to it.
  for (int quarter = -60; quarter <= 60; ++quarter) {
    for (const int step : {-1, 0, 1}) {
      float x = static_cast<float>(quarter * std::numbers::pi / 2);
      if (step != 0) x = std::nextafter(x, step > 0 ? 1e9F : -1e9F);
      sine_cosine(splat(x), s, c);
      ASSERT_NEAR(lanes(s)[0], std::sin(static_cast<double>(x)), kTrigError) << x;
      ASSERT_NEAR(lanes(c)[0], std::cos(static_cast<double>(x)), kTrigError) << x;
    }
  }
}

TEST(Lanes, TheHyperbolicTangentKeepsItsRelativeErrorForEveryFloat) {
  // Every 4096th positive float that is normal, from the least to infinity.
  double worst = 0;
  const auto begin = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::min());
  const auto end = std::bit_cast<std::uint32_t>(kInfinity);
  FloatLanes x{};
  for (std::uint32_t bits = begin; bits < end; bits += 4096 * kFloats) {
    for (std::uint32_t k = 0; k < kFloats; ++k) {
      x[k] = std::bit_cast<float>(std::min(bits + 4096 * k, end - 1));
    }
    const FloatLanes got = lanes(hyperbolic_tangent(load(x.data())));
    for (int k = 0; k < kFloats; ++k) {
      const double exact = std::tanh(static_cast<double>(x[k]));
      worst = std::max(worst, std::abs(got[k] - exact) / exact);
      ASSERT_LE(got[k], 1.0F) << x[k];
    }
  }
  EXPECT_LT(worst, 5e-7);
}

TEST(Lanes, TheHyperbolicTangentIsOddAndEndsAtOne) {
  Rng rng(35);
  for (int n = 0; n < 1000; ++n) {
    const auto x = static_cast<float>(rng.uniform(-12, 12));
    ASSERT_EQ(tanh_of(x), -tanh_of(-x)) << x;
  }
  EXPECT_EQ(std::bit_cast<std::uint32_t>(tanh_of(0.0F)), 0U);
  EXPECT_TRUE(std::signbit(tanh_of(-0.0F)));
  for (const float large : {9.2F, 100.0F, 3e38F, kInfinity}) {
    EXPECT_EQ(tanh_of(large), 1.0F) << large;
    EXPECT_EQ(tanh_of(-large), -1.0F) << large;
  }
  EXPECT_TRUE(std::isnan(tanh_of(kNan)));
}

}  // namespace
}  // namespace mjarm::simd
