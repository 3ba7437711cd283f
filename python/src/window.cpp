#include "python/src/window.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <utility>
#include <variant>

#include "mjarm/core/log.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/render/trail.hpp"
#include "mjarm/view/playback.hpp"
#include "mjarm/view/view_link.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::python {

namespace {
constexpr auto kRest = std::chrono::microseconds(500);
}

struct BoundWindow::Impl {
  Robot robot;
  bool has_trail, real_time;
  Sim sim;
  view::Playback playback;
  render::Overlay paths = {};
  render::Trail trail{{.max_points = 10000}};
  view::ViewLink link = {};
  view::ViewFrame frame = {};
  double last_time = 0;  // [s] of the loop's clock
  int due = 0;
  std::atomic<bool> close_wanted{false};
  std::promise<Result<void>> opened = {};
  std::thread drawer = {};

  Impl(const Robot& of, bool with_trail, bool keeps_time)
      : robot(of),
        has_trail(with_trail),
        real_time(keeps_time),
        sim(of.model),
        playback(of.model.timestep()) {
    sim.reset_home();
  }

  void draw(const std::string& title) {
    Result<view::Window> window = view::Window::open(robot.model, title, {.can_reset = false});
    if (!window) {
      link.closed = true;
      opened.set_value(fail(std::move(window.error())));
      return;
    }
    opened.set_value({});
    const Result<void> drawn =
        view::draw_until_closed(*window, link, [this] { return close_wanted.load(); });
    if (!drawn) log_warning(drawn.error().what);
  }

  void take_events(std::vector<Push>& pushes) {
    for (const view::ViewEvent& event : link.events.take()) {
      if (const auto* push = std::get_if<view::PushEvent>(&event)) {
        pushes.push_back({push->body, push->force_W, push->torque_W});
      } else if (const auto* release = std::get_if<view::ReleaseEvent>(&event)) {
        pushes.push_back({.body = release->body});
      } else {
        (void)playback.handle(event);
      }
    }
  }

  void offer() {
    if (!link.frames.is_empty()) return;
    frame.snapshot = sim.snapshot();
    frame.snapshot.time = last_time;
    frame.overlay = paths;
    trail.draw(frame.overlay);
    link.frames.post(frame);
  }
};

BoundWindow::BoundWindow(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BoundWindow::BoundWindow(BoundWindow&&) noexcept = default;
BoundWindow& BoundWindow::operator=(BoundWindow&& other) noexcept {
  if (this != &other) {
    close();
    impl_ = std::move(other.impl_);
  }
  return *this;
}
BoundWindow::~BoundWindow() { close(); }

Result<BoundWindow> BoundWindow::open(const Robot& robot, const std::string& title, bool trail,
                                      bool real_time) {
  auto impl = std::make_unique<Impl>(robot, trail, real_time);
  impl->drawer = std::thread([&self = *impl, title] { self.draw(title); });
  Result<void> opened = impl->opened.get_future().get();
  BoundWindow window(std::move(impl));
  if (!opened) return fail(std::move(opened.error()));
  window.impl_->offer();
  return window;
}

bool BoundWindow::is_open() const { return impl_ && !impl_->link.closed; }

void BoundWindow::close() {
  if (!impl_ || !impl_->drawer.joinable()) return;
  impl_->close_wanted = true;
  impl_->drawer.join();
}

void BoundWindow::add_path(std::span<const Pose> X_WT) {
  render::add_planned_path(impl_->paths, X_WT);
}

std::vector<Push> BoundWindow::sync(std::span<const double> qpos, std::span<const double> qvel,
                                    double time, const StopCheck& stop) {
  Impl& self = *impl_;
  std::vector<Push> pushes;
  if (!is_open()) return pushes;
  self.sim.set_state(qpos, qvel);
  if (time < self.last_time) self.trail.clear();  // the world was put back
  self.last_time = time;
  if (self.has_trail) self.trail.add(self.sim.tool(self.robot.arm).p);
  self.take_events(pushes);
  self.offer();
  if (self.due > 0) --self.due;
  while (self.due == 0 && is_open() && !is_stopped(stop)) {
    self.take_events(pushes);
    self.due = self.playback.steps_due();
    if (!self.real_time && !self.playback.paused()) break;
    if (self.due == 0) std::this_thread::sleep_for(kRest);
    self.offer();
  }
  return pushes;
}

}  // namespace mjarm::python
