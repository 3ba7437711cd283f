#include "mjarm/rl/normaliser.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm::rl {
namespace {

Normaliser normaliser_of(int size) {
  return {Eigen::VectorXd::Zero(size), Eigen::VectorXd::Ones(size), 0, 10};
}

/// Columns of very different sizes, the second far from 0.
std::vector<float> drawn_rows(std::size_t n, Rng& rng) {
  std::vector<float> out;
  for (std::size_t i = 0; i < n; ++i) {
    out.push_back(static_cast<float>(rng.normal()));
    out.push_back(static_cast<float>(1000 + 0.1 * rng.normal()));
    out.push_back(static_cast<float>(1e-3 * rng.normal()));
  }
  return out;
}

TEST(Normaliser, PortionsGiveTheMomentsOfTheWhole) {
  Rng rng(1);
  const std::vector<float> rows = drawn_rows(1000, rng);
  Normaliser portions = normaliser_of(3);
  for (std::size_t first = 0; first < 1000;) {
    const std::size_t count = std::min<std::size_t>(1 + rng.below(90), 1000 - first);
    portions.absorb(std::span(rows).subspan(3 * first, 3 * count));
    first += count;
  }
  EXPECT_EQ(portions.count, 1000);
  for (std::size_t k = 0; k < 3; ++k) {
    double mean = 0, variance = 0;
    for (std::size_t i = 0; i < 1000; ++i) mean += double(rows[3 * i + k]) / 1000;
    for (std::size_t i = 0; i < 1000; ++i) variance += std::pow(rows[3 * i + k] - mean, 2) / 1000;
    EXPECT_NEAR(portions.mean[k], mean, 1e-12 * std::abs(mean) + 1e-15);
    EXPECT_NEAR(portions.variance[k], variance, 1e-10 * variance);
  }
}

TEST(Normaliser, MakesStandardNumbers) {
  Rng rng(2);
  std::vector<float> rows = drawn_rows(5000, rng);
  Normaliser normaliser = normaliser_of(3);
  normaliser.absorb(rows);
  normaliser.apply(rows, rows);  // in place
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0, squares = 0;
    for (std::size_t i = k; i < rows.size(); i += 3) sum += rows[i], squares += rows[i] * rows[i];
    EXPECT_NEAR(sum / 5000, 0, 1e-3);
    EXPECT_NEAR(squares / 5000, 1, k == 2 ? 2e-2 : 1e-3);  // 1e-8 is felt beside 1e-6
  }
}

TEST(Normaliser, ClipsAndDoesNothingBeforeItHasSeenAnything) {
  const std::vector<float> rows = {1e6F, -1e6F, 0.5F};
  std::vector<float> out(3);
  Normaliser normaliser = normaliser_of(1);
  normaliser.apply(rows, out);
  EXPECT_EQ(out, rows);
  normaliser.count = 1;
  normaliser.clip = 5;
  normaliser.apply(rows, out);
  EXPECT_EQ(out[0], 5);
  EXPECT_EQ(out[1], -5);
  EXPECT_NEAR(out[2], 0.5, 1e-6);
}

TEST(Normaliser, ColumnsThatNeverChangeBecomeZero) {
  Normaliser normaliser = normaliser_of(1);
  const std::vector<float> rows(100, 0.3F);
  normaliser.absorb(rows);
  std::vector<float> out(100);
  normaliser.apply(rows, out);
  for (const float value : out) EXPECT_NEAR(value, 0, 1e-3);
}

}  // namespace
}  // namespace mjarm::rl
