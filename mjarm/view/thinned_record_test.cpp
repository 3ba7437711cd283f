#include "mjarm/view/thinned_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace mjarm::view {
namespace {

constexpr double kStep = 0.002;  // [s]

TEST(ThinnedRecord, KeepsAllUntilItIsFull) {
  ThinnedRecord<int> record(10);
  EXPECT_TRUE(record.empty());
  for (int i = 0; i < 10; ++i) record.add(i * kStep, [&] { return i; });
  ASSERT_EQ(record.size(), 10U);
  EXPECT_EQ(record.spacing(), 1U);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(record.at(i), static_cast<int>(i));
  record.clear();
  EXPECT_TRUE(record.empty());
}

/// However long: evenly spaced from the first step on, at least half full, never more than allowed,
/// and the end is never farther away than one spacing.
TEST(ThinnedRecord, StaysEvenAndBounded) {
  for (const std::size_t max : {2U, 3U, 7U, 8U, 100U}) {
    ThinnedRecord<int> record(max);
    for (int step = 0; step < 3000; ++step) {
      int asked = 0;
      record.add(step * kStep, [&] {
        ++asked;
        return step;
      });
      ASSERT_LE(record.size(), max);
      ASSERT_GE(2 * record.size(), std::min<std::size_t>(max, static_cast<std::size_t>(step) + 1));
      const auto spacing = static_cast<int>(record.spacing());
      for (std::size_t i = 0; i < record.size(); ++i) {
        ASSERT_EQ(record.at(i), static_cast<int>(i) * spacing) << max << " " << step;
        ASSERT_EQ(record.time(i), record.at(i) * kStep);
      }
      ASSERT_LT(step - record.at(record.size() - 1), spacing);
      // Nothing is made to be thrown away.
      ASSERT_EQ(asked, step % spacing == 0 ? 1 : 0);
    }
  }
}

TEST(ThinnedRecord, FindsTheNearestMoment) {
  ThinnedRecord<int> record(16);
  for (int step = 0; step < 100; ++step) record.add(1 + step * kStep, [&] { return step; });
  for (double time = 0.9; time < 1.3; time += 1e-4) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < record.size(); ++i) {
      if (std::abs(record.time(i) - time) < std::abs(record.time(best) - time)) best = i;
    }
    ASSERT_NEAR(std::abs(record.time(record.nearest(time)) - time),
                std::abs(record.time(best) - time), 1e-12)
        << time;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(record.nearest(-kInfinity), 0U);
  EXPECT_EQ(record.nearest(kInfinity), record.size() - 1);
}

}  // namespace
}  // namespace mjarm::view
