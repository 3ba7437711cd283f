#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/trig_series_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// A series of degree 8 by its roots: products of sin((x - root) / 2), and of what has no root.
struct Factors {
  std::vector<double> roots;    // an even number, at most 16
  std::vector<double> without;  // one for two roots that are missing

  double value(double x) const {
    double out = 1;
    for (const double root : roots) out *= std::sin(0.5 * (x - root));
    for (const double at : without) out *= 1.3 - std::cos(x - at);
    return out;
  }
  TrigSeries series() const {
    double f[TrigSeries::kSamples];
    for (int j = 0; j < TrigSeries::kSamples; ++j) f[j] = value(TrigSeries::sample(j));
    return TrigSeries(f);
  }
};

Factors random_factors(int count, Rng& rng) {
  Factors out;
  for (int i = 0; i < count; ++i) out.roots.push_back(rng.uniform(0, kTurn));
  for (int i = count; i < 16; i += 2) out.without.push_back(rng.uniform(0, kTurn));
  return out;
}

double off(double x, double root) { return std::abs(std::remainder(x - root, kTurn)); }

std::vector<TrigSeries::Root> roots_of(const TrigSeries& series, double touch) {
  TrigSeries::Root found[TrigSeries::kMaxRoots];
  const int count = series.roots(touch, found);
  return {found, found + count};
}

/// How many of the roots have none of those found within `far` or its spread.
int lost(const Factors& factors, const std::vector<TrigSeries::Root>& found, double far) {
  return static_cast<int>(std::ranges::count_if(factors.roots, [&](double root) {
    return std::ranges::none_of(found, [&](const auto& one) {
      return off(one.x, root) <= std::max(far, 1.01 * one.spread);
    });
  }));
}

TEST(TrigSeries, IsTheFunctionThatItsValuesAreOf) {
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const Factors factors = random_factors(2 * static_cast<int>(rng.below(9)), rng);
    const TrigSeries series = factors.series();
    EXPECT_LT(series.noise, 1e-13);
    const double x = rng.uniform(-10, 10), step = 1e-4;
    const auto v = series.at(x);
    const double before = factors.value(x - step), after = factors.value(x + step);
    EXPECT_NEAR(v.f, factors.value(x), 1e-13 * series.largest);
    EXPECT_NEAR(v.slope, (after - before) / (2 * step), 1e-5 * series.largest);
    EXPECT_NEAR(v.bend, (after + before - 2 * v.f) / (step * step), 1e-4 * series.largest);
  }
}

TEST(TrigSeries, WhatIsNoSeriesHasNoise) {
  double f[TrigSeries::kSamples];
  for (int j = 0; j < TrigSeries::kSamples; ++j) f[j] = std::cos(9 * TrigSeries::sample(j));
  EXPECT_GT(TrigSeries(f).noise, 0.9);
}

TEST(TrigSeries, FindsEveryRoot) {
  Rng rng(2);
  for (int i = 0; i < 2000; ++i) {
    const int count = 2 * static_cast<int>(rng.below(9));
    const Factors factors = random_factors(count, rng);
    const auto found = roots_of(factors.series(), 1e-13);
    EXPECT_EQ(lost(factors, found, 1e-3), 0) << i;
    for (const auto& one : found) {
      if (one.spread > 0) continue;
      EXPECT_TRUE(
          std::ranges::any_of(factors.roots, [&](double r) { return off(one.x, r) < 1e-3; }));
    }
  }
}

/// Two, three or four within 1e-4 to 0.1 rad, where neighbouring points of any grid show none.
TEST(TrigSeries, FindsClusters) {
  Rng rng(3);
  for (int i = 0; i < 2000; ++i) {
    Factors factors = random_factors(8, rng);
    const int crowd = 2 + static_cast<int>(rng.below(3));
    const double width = std::pow(10, rng.uniform(crowd == 2 ? -4 : -2, -1));
    for (int k = 1; k < crowd; ++k) factors.roots[k] = factors.roots[0] + k * width;
    EXPECT_EQ(lost(factors, roots_of(factors.series(), 1e-13), 0.1 * width), 0) << i;
  }
}

TEST(TrigSeries, TellsRootsThatMayBeNone) {
  Rng rng(4);
  for (int i = 0; i < 500; ++i) {
    Factors factors = random_factors(6, rng);
    factors.roots[1] = factors.roots[0];
    const auto found = roots_of(factors.series(), 1e-12);
    EXPECT_TRUE(std::ranges::any_of(found, [&](const auto& one) {
      return one.spread > 0 && off(one.x, factors.roots[0]) <= one.spread;
    })) << i;
    EXPECT_EQ(lost(factors, found, 1e-3), 0) << i;
  }
}

}  // namespace
}  // namespace mjarm::detail
