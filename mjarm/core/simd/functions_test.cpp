#include "mjarm/core/simd/functions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"

namespace mjarm::simd {
namespace {

/// Largest error of sine_cosine() for |x| <= size, beside that of the standard library.
template <class V, class T>
double worst_sine_or_cosine(double size, Rng& rng) {
  constexpr int kLanes = sizeof(V) / sizeof(T);
  double worst = 0;
  for (int i = 0; i < 50'000; ++i) {
    T x[kLanes], s[kLanes], c[kLanes];
    for (T& value : x) value = static_cast<T>(rng.uniform(-size, size));
    V sine, cosine;
    sine_cosine(load(x), sine, cosine);
    store(s, sine);
    store(c, cosine);
    for (int k = 0; k < kLanes; ++k) {
      worst = std::max({worst, std::abs(s[k] - std::sin(static_cast<double>(x[k]))),
                        std::abs(c[k] - std::cos(static_cast<double>(x[k])))});
    }
  }
  return worst;
}

TEST(SimdFunctions, SineAndCosineKeepTheirBound) {
  Rng rng(1);
  double worst = 0;
  for (const double size : {1e-3, 4.0, kMaxAngle}) {
    worst = std::max(worst, worst_sine_or_cosine<Floats, float>(size, rng));
    EXPECT_LT((worst_sine_or_cosine<Doubles, double>(size, rng)), 1e-15) << size;
  }
  EXPECT_LT(worst, kTrigError);
  EXPECT_GT(worst, 1e-8);
  EXPECT_LT((worst_sine_or_cosine<Doubles, double>(9e4, rng)), 2e-15);
}

TEST(SimdFunctions, MasksAndLanesAgreeWithPlainArithmetic) {
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    float a[kFloats], b[kFloats], out[kFloats];
    for (int k = 0; k < kFloats; ++k) {
      a[k] = static_cast<float>(rng.uniform(-1, 1));
      b[k] = rng.uniform() < 0.25 ? a[k] : static_cast<float>(rng.uniform(-1, 1));
    }
    const LaneBits below = less(load(a), load(b));
    store(out, zero_where(below, load(a)));
    float low[kFloats], high[kFloats];
    store(low, smaller(load(a), load(b)));
    store(high, larger(load(a), load(b)));
    for (int k = 0; k < kFloats; ++k) {
      EXPECT_EQ((below >> k) & 1, a[k] < b[k] ? 1U : 0U);
      EXPECT_EQ(out[k], a[k] < b[k] ? 0.0F : a[k]);
      EXPECT_EQ(low[k], std::min(a[k], b[k]));
      EXPECT_EQ(high[k], std::max(a[k], b[k]));
    }
    EXPECT_EQ(below & ~kAllLanes, 0U);
    const int count = static_cast<int>((kFloats + 1) * rng.uniform());
    float some[kFloats + 1];
    std::fill(some, some + kFloats + 1, 7.0F);
    store_some(some, load_some(a, count), count);
    for (int k = 0; k <= kFloats; ++k) EXPECT_EQ(some[k], k < count ? a[k] : 7.0F);
  }
}

TEST(SimdFunctions, NotANumberIsNeverLess) {
  const Floats nan = splat(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(less(nan, splat(1.0F)), 0U);
  EXPECT_EQ(less(splat(1.0F), nan), 0U);
  EXPECT_EQ(less(splat(-1.0F), splat(1.0F)), kAllLanes);
}

TEST(SimdFunctions, LogarithmsAreThoseOfTheStandardLibrary) {
  Rng rng(5);
  const auto worst_of = [](double (&x)[kDoubles]) {
    double out[kDoubles], worst = 0;
    store(out, natural_logarithm(load(x)));
    for (int k = 0; k < kDoubles; ++k) {
      const double right = std::log(x[k]);
      worst = std::max(worst, std::abs(out[k] - right) / std::max(1.0, std::abs(right)));
    }
    return worst;
  };
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    double x[kDoubles];
    for (double& value : x) {
      value = i % 2 == 0 ? std::exp(rng.uniform(-700, 700)) : rng.uniform(0.5, 2);
    }
    worst = std::max(worst, worst_of(x));
  }
  EXPECT_LT(worst, 4e-16);
  double ones[kDoubles];
  std::ranges::fill(ones, 1.0);
  EXPECT_EQ(worst_of(ones), 0);
}

}  // namespace
}  // namespace mjarm::simd
