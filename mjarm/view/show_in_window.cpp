#include "mjarm/view/show_in_window.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include "mjarm/core/os.hpp"

namespace mjarm::view {

Result<ViewStats> show_in_window(const Model& model, const std::string& title,
                                 const WindowOptions& window_options, const ShowOptions& options,
                                 const std::function<void(ViewLink&)>& simulate) {
  using Clock = std::chrono::steady_clock;
  Result<Window> window = Window::open(model, title, window_options);
  if (!window) {
    // What is missing here is a display, without which nothing can be seen in a window.
    Error error = std::move(window.error());
    if (error.code == Errc::not_available) error.code = Errc::impossible;
    return fail(std::move(error));
  }
  if (options.on_open) options.on_open(*window);
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  ViewLink link;
  std::thread worker([&] { simulate(link); });
  const Result<void> drawn = draw_until_closed(
      *window, link, [&] { return interrupted() || (options.seconds > 0 && Clock::now() >= end); });
  worker.join();
  if (!drawn) return fail(drawn.error());
  return window->stats();
}

}  // namespace mjarm::view
