#include "mjarm/view/remote_window.hpp"

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <system_error>
#include <thread>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::view {

/// A window as it was asked for, shared by the two threads.
struct RemoteWindow::Order {
  Model model;
  std::string title;
  WindowOptions options;
  ViewLink link = {};
  std::atomic<bool> close_wanted{false};
  std::promise<Result<void>> opened = {};
  std::promise<void> gone = {};
};

namespace {

/// Where orders wait for the main thread.
class Desk {
 public:
  void place(std::shared_ptr<RemoteWindow::Order> order) {
    const std::scoped_lock lock(mutex_);
    order_ = std::move(order);
    changed_.notify_one();
  }
  void close() {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
    changed_.notify_one();
  }
  /// Waits for the next order; null once the work is through.
  std::shared_ptr<RemoteWindow::Order> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || order_; });
    return std::exchange(order_, nullptr);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<RemoteWindow::Order> order_;
  bool closed_ = false;
};

/// A process has one main thread, and so one desk at most.
std::atomic<Desk*> the_desk{nullptr};

Result<void> show_window(const ShowOrder& order) {
  Result<Window> window = Window::open(order.model, order.title, order.options);
  if (!window) {
    order.opened(fail(std::move(window.error())));
    return {};
  }
  order.opened({});
  return draw_until_closed(*window, order.link, order.ended);
}

void show(const Shower& shower, RemoteWindow::Order& order) {
  const Result<void> shown =
      shower({.model = order.model,
              .title = order.title,
              .options = order.options,
              .link = order.link,
              .opened =
                  [&order](Result<void> result) {
                    if (!result) order.link.closed = true;
                    order.opened.set_value(std::move(result));
                  },
              .ended = [&order] { return order.close_wanted.load() || interrupted(); }});
  // The work sees a closed window, and ends as it does then.
  order.link.closed = true;
  if (!shown) log_warning(shown.error().what);
}

}  // namespace

void run_beside(const Shower& shower, const std::function<void()>& work) {
  Desk desk;
  the_desk = &desk;
  std::thread worker;
  try {
    worker = std::thread([&] {
      work();
      desk.close();
    });
  } catch (const std::system_error&) {  // no thread is to be had
    the_desk = nullptr;
    return work();
  }
  while (const std::shared_ptr<RemoteWindow::Order> order = desk.next()) {
    show(shower, *order);
    order->gone.set_value();
  }
  worker.join();
  the_desk = nullptr;
}

void run_beside_windows(bool headless, const std::function<void()>& work) {
  if (headless || !has_display()) return work();
  run_beside(show_window, work);
}

bool RemoteWindow::is_possible() noexcept { return the_desk != nullptr; }

Result<RemoteWindow> RemoteWindow::open(const Model& model, const std::string& title,
                                        const WindowOptions& options) {
  Desk* const desk = the_desk;
  if (desk == nullptr) return fail(Errc::not_available, text(msg::view_no_display));
  auto order = std::make_shared<Order>(model, title, options);
  std::future<Result<void>> opened = order->opened.get_future();
  desk->place(order);
  RemoteWindow window(std::move(order));
  if (Result<void> result = opened.get(); !result) return fail(std::move(result.error()));
  return window;
}

Result<std::optional<RemoteWindow>> RemoteWindow::open_where_possible(
    const Model& model, const std::string& title, const WindowOptions& options) {
  if (!is_possible()) {
    if (!has_display()) log_info(text(msg::view_without));
    return std::nullopt;
  }
  Result<RemoteWindow> window = open(model, title, options);
  if (window) return std::move(*window);
  if (window.error().code != Errc::not_available) return fail(std::move(window.error()));
  log_info(window.error().what);
  return std::nullopt;
}

void RemoteWindow::close() {
  if (!order_) return;
  order_->close_wanted = true;
  order_->gone.get_future().wait();
  order_.reset();
}

RemoteWindow::~RemoteWindow() { close(); }
RemoteWindow::RemoteWindow(RemoteWindow&&) noexcept = default;
RemoteWindow& RemoteWindow::operator=(RemoteWindow&& other) noexcept {
  if (this != &other) {
    close();
    order_ = std::move(other.order_);
  }
  return *this;
}
ViewLink& RemoteWindow::link() const { return order_->link; }

}  // namespace mjarm::view
