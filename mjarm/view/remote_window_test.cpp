#include "mjarm/view/remote_window.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "mjarm/view/real_window_test.hpp"

namespace mjarm::view {
namespace {

TEST(RemoteWindow, WithoutAMainThreadThatStandsReadyThereIsNone) {
  const Model model = testing::window_scene();
  EXPECT_FALSE(RemoteWindow::is_possible());
  const Result<RemoteWindow> window = RemoteWindow::open(model, "none", {});
  ASSERT_FALSE(window);
  EXPECT_EQ(window.error().code, Errc::not_available);
  const auto maybe = RemoteWindow::open_where_possible(model, "none", {});
  ASSERT_TRUE(maybe);
  EXPECT_FALSE(*maybe);
}

TEST(BesideWindows, HeadlessWorkRunsInThisThread) {
  const std::thread::id here = std::this_thread::get_id();
  const int answer = beside_windows(true, [&] {
    EXPECT_EQ(std::this_thread::get_id(), here);
    EXPECT_FALSE(RemoteWindow::is_possible());
    return 42;
  });
  EXPECT_EQ(answer, 42);
}

TEST(BesideWindows, WorkOpensAWindowAndClosesIt) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "DISPLAY is not set";
  const testing::Turn turn;
  const Model model = testing::window_scene();
  const std::thread::id here = std::this_thread::get_id();
  const bool seen = beside_windows(false, [&] {
    EXPECT_NE(std::this_thread::get_id(), here);
    const Result<RemoteWindow> window = RemoteWindow::open(model, "mjarm remote test", {});
    if (!window) {
      ADD_FAILURE() << window.error().what;
      return false;
    }
    ViewFrame frame;
    frame.snapshot = Sim(model).snapshot();
    window->link().frames.post(frame);
    for (int i = 0; i < 1000 && !window->link().frames.is_empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return window->is_open() && window->link().frames.is_empty();
  });
  EXPECT_TRUE(seen);
  EXPECT_FALSE(RemoteWindow::is_possible());
}

}  // namespace
}  // namespace mjarm::view
