#include "mjarm/core/rng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace mjarm {
namespace {

TEST(Rng, MatchesTheReferenceGenerator) {
  // splitmix64 from 1234567 gives 6457827717110365317, 3203168211198807973, ... (published test
  // vector); xoshiro256** of a state returns rotl(s1 * 5, 7) * 9 first.
  Rng rng(1234567);
  const std::uint64_t s1 = 3203168211198807973ULL;
  const std::uint64_t product = s1 * 5;
  EXPECT_EQ(rng.next(), ((product << 7) | (product >> 57)) * 9);
}

TEST(Rng, GoesThroughThePublishedSequence) {
  // The first outputs of the reference implementation of xoshiro256** from the state 1, 2, 3, 4.
  Rng rng(std::array<std::uint64_t, 4>{1, 2, 3, 4});
  for (const std::uint64_t expected :
       {11520ULL, 0ULL, 1509978240ULL, 1215971899390074240ULL, 1216172134540287360ULL,
        607988272756665600ULL, 16172922978634559625ULL, 8476171486693032832ULL,
        10595114339597558777ULL, 2904607092377533576ULL}) {
    ASSERT_EQ(rng.next(), expected);
  }
}

TEST(Rng, BelowIsTheUpperHalfOfAFullProduct) {
  __extension__ using Wide = unsigned __int128;
  Rng rng(12), twin(12), bounds(13);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t n = (bounds.next() >> bounds.below(64)) | 1;
    const std::uint64_t drawn = rng.below(n);
    // What would favour some numbers is thrown away: the first -n mod n of each run of products.
    Wide product = static_cast<Wide>(twin.next()) * n;
    while (static_cast<std::uint64_t>(product) < (0 - n) % n) {
      product = static_cast<Wide>(twin.next()) * n;
    }
    ASSERT_EQ(drawn, static_cast<std::uint64_t>(product >> 64)) << n;
    ASSERT_LT(drawn, n);
  }
}

TEST(Rng, EveryBitIsSetHalfOfTheTimeAndKnowsNothingOfTheOneBefore) {
  Rng rng(14);
  constexpr int kCount = 40000;
  std::array<int, 64> set{}, kept{};
  std::uint64_t before = rng.next();
  for (int i = 0; i < kCount; ++i) {
    const std::uint64_t now = rng.next();
    for (std::size_t b = 0; b < 64; ++b) {
      set.at(b) += static_cast<int>((now >> b) & 1);
      kept.at(b) += static_cast<int>(((now ^ before) >> b) & 1);
    }
    before = now;
  }
  for (std::size_t b = 0; b < 64; ++b) {  // five standard deviations
    EXPECT_NEAR(set.at(b), kCount / 2, 500) << b;
    EXPECT_NEAR(kept.at(b), kCount / 2, 500) << b;
  }
}

TEST(Rng, NormalFollowsItsDistribution) {
  Rng rng(15);
  constexpr int kCount = 50000;
  std::array<int, 13> below{};
  for (int i = 0; i < kCount; ++i) {
    const double x = rng.normal();
    for (std::size_t k = 0; k < below.size(); ++k) {
      below.at(k) += x < -3 + 0.5 * static_cast<double>(k);
    }
  }
  for (std::size_t k = 0; k < below.size(); ++k) {
    const double share = 0.5 * std::erfc((3 - 0.5 * static_cast<double>(k)) / std::sqrt(2.0));
    EXPECT_NEAR(below.at(k) / static_cast<double>(kCount), share, 0.011) << k;
  }
}

TEST(Rng, SameSeedSameNumbers) {
  Rng a(42), b(42), other_seed(43), other_stream(42, 1);
  int same_seed = 0, same_stream = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t value = a.next();
    ASSERT_EQ(value, b.next());
    same_seed += value == other_seed.next();
    same_stream += value == other_stream.next();
  }
  EXPECT_EQ(same_seed, 0);
  EXPECT_EQ(same_stream, 0);
}

TEST(Rng, GoesOnFromItsState) {
  Rng rng(5, 3);
  for (int i = 0; i < 100; ++i) rng.normal();
  Rng other(rng.state());
  for (int i = 0; i < 100; ++i) ASSERT_EQ(rng.next(), other.next());
}

TEST(Rng, StreamsDoNotMeet) {
  std::set<std::uint64_t> firsts;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (std::uint64_t stream = 0; stream < 30; ++stream) firsts.insert(Rng(seed, stream).next());
  }
  EXPECT_EQ(firsts.size(), 900u);
}

TEST(Rng, UniformFillsItsRange) {
  Rng rng(7);
  constexpr int kCount = 200000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kCount; ++i) {
    const double u = rng.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / kCount, 1.0 / 2, 4e-3);
  EXPECT_NEAR(squares / kCount, 1.0 / 3, 4e-3);
}

TEST(Rng, UniformNeverReachesTheUpperEnd) {
  Rng rng(8);
  const double upper = std::nextafter(1.0, 2.0);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(rng.uniform(1, upper), 1.0);
    const double value = rng.uniform(-3, 5);
    ASSERT_TRUE(value >= -3 && value < 5);
  }
  EXPECT_EQ(rng.uniform(2, 2), 2);
}

TEST(Rng, BelowIsEven) {
  Rng rng(9);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) counts.at(rng.below(7))++;
  for (const int count : counts) EXPECT_NEAR(count, 10000, 400);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(rng.below(1), 0u);
  // Bounds above 2^63 are where the naive modulo is wrong by half.
  int upper_half = 0;
  const std::uint64_t bound = 3ULL << 62;
  for (int i = 0; i < 30000; ++i) upper_half += rng.below(bound) >= (bound / 3);
  EXPECT_NEAR(upper_half, 20000, 400);
}

TEST(Rng, NormalHasItsMoments) {
  Rng rng(10);
  constexpr int kCount = 200000;
  double sum = 0, squares = 0, fourths = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = rng.normal();
    sum += x;
    squares += x * x;
    fourths += x * x * x * x;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(squares / kCount, 1, 0.02);
  EXPECT_NEAR(fourths / kCount, 3, 0.15);
}

}  // namespace
}  // namespace mjarm
