#include "mjarm/view/real_time.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/rng.hpp"

namespace mjarm::view {
namespace {

TEST(RealTimePacer, KeepsUpWithTheClockWhateverTheFrames) {
  Rng rng(3);
  RealTimePacer pacer(0.002);
  double now = 100;
  EXPECT_EQ(pacer.steps_due_at(now), 0);
  int steps = 0;
  for (int i = 0; i < 2000; ++i) {
    now += rng.uniform(0, 0.03);
    steps += pacer.steps_due_at(now);
    ASSERT_NEAR(steps * 0.002, now - 100, 0.002 + 1e-9);
  }
}

TEST(RealTimePacer, RunsFasterOrSlowerThanTheClock) {
  for (const double speed : {0.25, 4.0}) {
    RealTimePacer pacer(0.001, speed);
    int steps = pacer.steps_due_at(0);
    for (int i = 1; i <= 100; ++i) steps += pacer.steps_due_at(0.01 * i);
    EXPECT_NEAR(steps, 1000 * speed, 1);
  }
}

TEST(RealTimePacer, PauseIsNotCaughtUp) {
  RealTimePacer pacer(0.01);
  EXPECT_EQ(pacer.steps_due_at(0), 0);
  EXPECT_EQ(pacer.steps_due_at(0.1), 10);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(pacer.steps_due_at(0.1 + 0.1 * i, true), 0);
  EXPECT_EQ(pacer.steps_due_at(5.0 + 0.05), 5);
}

TEST(RealTimePacer, AHiccupIsCaughtUpInPart) {
  RealTimePacer pacer(0.01);
  EXPECT_EQ(pacer.steps_due_at(0), 0);
  EXPECT_EQ(pacer.steps_due_at(60), 25);
  EXPECT_EQ(pacer.steps_due_at(60), 0);
  EXPECT_EQ(pacer.steps_due_at(59), 0) << "a clock that falls is no time passed";
}

}  // namespace
}  // namespace mjarm::view
