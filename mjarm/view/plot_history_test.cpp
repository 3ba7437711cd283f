#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/view/plot_history_internal.hpp"

namespace mjarm::view {
namespace {

const double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Everything that was given, to compare with.
struct Given {
  std::vector<double> times;
  std::vector<double> values;

  [[nodiscard]] bool holds(const TimedValue& one) const {
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] != one.time) continue;
      if (values[i] == one.value || (std::isnan(values[i]) && std::isnan(one.value))) return true;
    }
    return false;
  }
};

void expect_rising(const std::vector<TimedValue>& column) {
  for (std::size_t i = 1; i < column.size(); ++i) ASSERT_LT(column[i - 1].time, column[i].time);
}

TEST(PlotHistory, IsWhatWasGivenAsLongAsThereIsRoom) {
  PlotHistory history(2, 8, 0);
  for (int i = 0; i < 8; ++i) {
    const double row[] = {1.0 * i, i == 3 ? kNothing : -2.0 * i};
    history.add(0.5 * i, row);
  }
  EXPECT_EQ(history.places(), 8U);
  for (const std::size_t column : {0U, 1U}) {
    const std::vector<TimedValue> out = history.column(column);
    ASSERT_EQ(out.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_EQ(out[i].time, 0.5 * static_cast<double>(i));
      if (column == 1 && i == 3) {
        EXPECT_TRUE(std::isnan(out[i].value)) << "a gap stays one";
      } else {
        EXPECT_EQ(out[i].value, (column == 0 ? 1.0 : -2.0) * static_cast<double>(i));
      }
    }
  }
}

/// For any number of places and rows, against all that was given: nothing is made up, nothing grows
/// without bound, no peak is lost and the last row is the last.
TEST(PlotHistory, KeepsPeaksInBoundedMemoryHoweverLongItGets) {
  Rng rng(6);
  for (const std::size_t places : {2U, 3U, 5U, 16U, 31U}) {
    PlotHistory history(1, places, 0);
    Given given;
    for (int i = 0; i < 700; ++i) {
      const double value = rng.uniform() < 0.1 ? kNothing : rng.normal();
      given.times.push_back(0.01 * i + 1e-3 * rng.uniform());
      given.values.push_back(value);
      history.add(given.times.back(), {&value, 1});
      ASSERT_LE(history.places(), places);
      if (i % 13 != 0 && i != 699) continue;
      const std::vector<TimedValue> column = history.column(0);
      ASSERT_LE(column.size(), 2 * places + 1);
      expect_rising(column);
      for (const TimedValue& one : column) ASSERT_TRUE(given.holds(one)) << places << " " << i;
      double least = kNothing, greatest = kNothing;
      for (const double seen : given.values) {
        least = std::fmin(least, seen);
        greatest = std::fmax(greatest, seen);
      }
      double least_kept = kNothing, greatest_kept = kNothing;
      for (const TimedValue& one : column) {
        least_kept = std::fmin(least_kept, one.value);
        greatest_kept = std::fmax(greatest_kept, one.value);
      }
      ASSERT_EQ(least_kept, least) << places << " " << i;
      ASSERT_EQ(greatest_kept, greatest) << places << " " << i;
      ASSERT_EQ(column.back().time, given.times.back());
    }
  }
}

/// Only the latest stretch of time, as fine at its end as at its beginning, however fast rows come.
TEST(PlotHistory, ASpanForgetsWhatIsOlder) {
  for (const double step : {0.001, 0.05, 0.7}) {
    constexpr double kSpan = 2;
    PlotHistory history(1, 20, kSpan);
    double peak_time = 0;
    for (int i = 0; i < 5000; ++i) {
      const double time = step * i;
      const double value = i % 97 == 0 ? 9 : std::sin(time);
      if (i % 97 == 0) peak_time = time;
      history.add(time, {&value, 1});
      ASSERT_LE(history.places(), 20U);
    }
    const std::vector<TimedValue> column = history.column(0);
    const double now = step * 4999;
    expect_rising(column);
    EXPECT_EQ(column.back().time, now);
    EXPECT_GE(column.front().time, now - kSpan - std::max(step, kSpan / 20));
    EXPECT_LE(column.front().time, now - kSpan + 2 * std::max(step, kSpan / 20));
    if (peak_time < now - kSpan) continue;
    const auto peak = std::ranges::max_element(column, {}, &TimedValue::value);
    EXPECT_EQ(peak->value, 9) << "a peak inside it is seen";
    EXPECT_GE(peak->time, column.front().time);
  }
}

TEST(PlotHistory, ClearedItBeginsAnew) {
  PlotHistory history(3, 4, 0);
  EXPECT_TRUE(history.column(2).empty());
  const double row[] = {1, 2, 3};
  for (int i = 0; i < 100; ++i) history.add(i, row);
  history.clear();
  EXPECT_EQ(history.places(), 0U);
  EXPECT_TRUE(history.column(0).empty());
  // As fine as at first, though it was thinned before.
  for (int i = 0; i < 4; ++i) history.add(i, row);
  EXPECT_EQ(history.column(1).size(), 4U);
  // All columns of a row without numbers are gaps, and no row is lost.
  const double none[] = {kNothing, kNothing, kNothing};
  history.clear();
  history.add(5, none);
  ASSERT_EQ(history.column(0).size(), 1U);
  EXPECT_EQ(history.column(0)[0].time, 5);
  EXPECT_TRUE(std::isnan(history.column(0)[0].value));
}

/// Fewer than two places are two.
TEST(PlotHistory, HasRoomForTwoAtLeast) {
  for (const std::size_t places : {0U, 1U, 2U}) {
    PlotHistory history(1, places, 0);
    for (int i = 0; i < 50; ++i) {
      const double value = i;
      history.add(i, {&value, 1});
    }
    const std::vector<TimedValue> column = history.column(0);
    EXPECT_LE(column.size(), 5U);
    EXPECT_EQ(column.front().value, 0);
    EXPECT_EQ(column.back().value, 49);
  }
}

}  // namespace
}  // namespace mjarm::view
