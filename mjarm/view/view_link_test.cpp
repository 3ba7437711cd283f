#include "mjarm/view/view_link.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "mjarm/view/real_window_test.hpp"

namespace mjarm::view {
namespace {

using LinkedWindow = testing::RealWindow;

/// The thread that simulates posts what it likes and gets what the user does; nobody waits.
TEST_F(LinkedWindow, CarriesFramesOneWayAndEventsTheOther) {
  ViewLink link;
  std::atomic<bool> paused{false};
  std::atomic<long> posted{0};
  std::thread worker([&] {
    Sim sim(model_);
    ViewFrame frame;
    while (!link.closed) {
      for (const ViewEvent& event : link.events.take()) {
        if (const auto* pause = std::get_if<PauseEvent>(&event)) paused = pause->paused;
      }
      if (!sim.step({})) break;
      frame.snapshot = sim.snapshot();
      link.frames.post(frame);
      ++posted;
    }
  });
  std::thread user([&] {
    for (int i = 0; i < 20 && !paused; ++i) xdotool({"key", "space", "sleep", "0.2"});
    for (int i = 0; i < 20 && !link.closed; ++i) xdotool({"key", "Escape", "sleep", "0.2"});
  });
  const Result<void> drawn = draw_until_closed(*window_, link, [] { return false; });
  worker.join();
  user.join();
  EXPECT_TRUE(drawn);
  EXPECT_TRUE(link.closed);
  EXPECT_FALSE(window_->is_open());
  EXPECT_TRUE(paused);
  // Many more states than frames: nothing waited for the window.
  EXPECT_GT(posted, window_->stats().frames);
}

TEST_F(LinkedWindow, EndsWhenItIsTold) {
  ViewLink link;
  int asked = 0;
  EXPECT_TRUE(draw_until_closed(*window_, link, [&asked] { return ++asked > 3; }));
  EXPECT_TRUE(link.closed);
  EXPECT_TRUE(window_->is_open());
}

}  // namespace
}  // namespace mjarm::view
