#include "mjarm/session/simulate_world.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace mjarm::session {
namespace {

/// Steps as often as the user asks for.
struct CountingWorld {
  void handle(const view::ViewEvent& event) {
    if (const auto* step = std::get_if<view::StepEvent>(&event)) due += step->steps;
  }
  int steps_due() { return std::exchange(due, 0); }
  void step() { ++steps; }
  void fill(view::ViewFrame& frame) const { frame.status = std::to_string(steps); }
  int due = 0;
  int steps = 0;
};

/// The same with something that is dragged once.
struct DraggedWorld : CountingWorld {
  bool take_drags() { return std::exchange(drags, 0) > 0; }
  void fill(view::ViewFrame& frame) const { frame.status = drags > 0 ? "before" : "after"; }
  int drags = 1;
};

/// Waits for a frame that says so.
bool shows(view::ViewLink& link, const std::string& status) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  view::ViewFrame frame;
  while (std::chrono::steady_clock::now() < end) {
    if (link.frames.take(frame) && frame.status == status) return true;
    std::this_thread::yield();
  }
  return false;
}

TEST(SimulateWorld, DoesWhatIsAskedForAndShowsIt) {
  view::ViewLink link;
  CountingWorld world;
  std::thread worker([&] { simulate_world(world, link); });
  EXPECT_TRUE(shows(link, "0")) << "the first frame comes without any event";
  link.events.push({view::StepEvent{3}, view::PauseEvent{true}, view::StepEvent{4}});
  EXPECT_TRUE(shows(link, "7"));
  // Nothing changes: no frame.
  view::ViewFrame frame;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(link.frames.take(frame));
  link.closed = true;
  worker.join();
  EXPECT_EQ(world.steps, 7);
}

TEST(SimulateWorld, EndsInTheMiddleOfManySteps) {
  view::ViewLink link;
  CountingWorld world;
  std::thread worker([&] { simulate_world(world, link); });
  link.events.push({view::StepEvent{2'000'000'000}});
  while (link.frames.is_empty()) std::this_thread::yield();
  link.closed = true;
  worker.join();
  EXPECT_LT(world.steps, 2'000'000'000);
}

TEST(SimulateWorld, ADragIsAChangeToBeShown) {
  view::ViewLink link;
  DraggedWorld world;
  std::thread worker([&] { simulate_world(world, link); });
  EXPECT_TRUE(shows(link, "after"));
  link.closed = true;
  worker.join();
}

}  // namespace
}  // namespace mjarm::session
