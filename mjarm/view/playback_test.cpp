#include "mjarm/view/playback.hpp"

#include <gtest/gtest.h>

#include "mjarm/view/view_stats.hpp"

namespace mjarm::view {
namespace {

TEST(Playback, FollowsPauseSpeedAndSteps) {
  Playback playback(0.01);
  EXPECT_EQ(playback.steps_due_at(0), 0);
  EXPECT_EQ(playback.steps_due_at(0.1), 10);
  EXPECT_TRUE(playback.handle(SpeedEvent{0.5}));
  EXPECT_EQ(playback.speed(), 0.5);
  EXPECT_EQ(playback.steps_due_at(0.2), 5);
  EXPECT_TRUE(playback.handle(PauseEvent{true}));
  EXPECT_EQ(playback.steps_due_at(0.3), 0);
  EXPECT_TRUE(playback.handle(StepEvent{1}));
  EXPECT_TRUE(playback.handle(StepEvent{1}));
  EXPECT_EQ(playback.steps_due_at(0.4), 2);
  EXPECT_EQ(playback.steps_due_at(0.5), 0);
  // The pause does not count afterwards.
  EXPECT_TRUE(playback.handle(PauseEvent{false}));
  EXPECT_EQ(playback.steps_due_at(0.6), 5);
}

TEST(Playback, LeavesTheRestToOthers) {
  Playback playback(0.01, true);
  EXPECT_FALSE(playback.handle(StepEvent{-1}));
  EXPECT_FALSE(playback.handle(ResetEvent{}));
  EXPECT_FALSE(playback.handle(PushEvent{}));
  EXPECT_EQ(playback.steps_due_at(1), 0);
}

TEST(FrameCounter, CountsFramesAndSimulatedTime) {
  FrameCounter counter(10);
  EXPECT_EQ(counter.stats().frames, 0);
  counter.add(10.1, 10.2, 0, false);
  counter.add(10.2, 10.3, 0.2, false);
  counter.add(10.3, 10.4, 0.2, true);  // paused
  counter.add(10.5, 10.6, 0.2, false);
  counter.add(10.6, 10.7, 0.0, false);  // went back
  counter.add(10.7, 10.8, 0.1, false);
  const ViewStats stats = counter.stats();
  EXPECT_EQ(stats.frames, 6);
  EXPECT_NEAR(stats.fps, 5 / 0.6, 1e-9);
  EXPECT_NEAR(stats.frame_ms, 100, 1e-9);
  EXPECT_NEAR(stats.first_frame_ms, 200, 1e-9);
  EXPECT_NEAR(stats.sim_rate, 0.3 / 0.2, 1e-9);
}

}  // namespace
}  // namespace mjarm::view
