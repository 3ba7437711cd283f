#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "mjarm/core/result.hpp"
#include "mjarm/view/view_link.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::view {

/// What shows a model in the place of a window, and how it answers whoever asked for it.
struct ShowOrder {
  const Model& model;
  const std::string& title;
  const WindowOptions& options;
  ViewLink& link;
  std::function<void(Result<void>)> opened;  ///< called once: it is to be seen, or why it is not
  std::function<bool()> ended;               ///< true once it is to go
};
/// Shows an order until it is to go, or the user closes it. Called from the main thread.
/// @return what went wrong while it was shown.
using Shower = std::function<Result<void>(const ShowOrder& order)>;

/// Runs `work` in a thread of its own, while this one, the main thread, shows with `shower` the
/// windows that it asks for: a page in the place of a window. Returns when `work` is through.
void run_beside(const Shower& shower, const std::function<void()>& work);

/// Runs `work` in a thread of its own, while this one, the main thread, opens the windows that it
/// asks for and draws them. Returns when `work` is through.
/// @param headless  `work` runs in this thread, and there are no windows; so it is without a
/// display.
void run_beside_windows(bool headless, const std::function<void()>& work);

/// The same for work with a result.
template <class Work>
[[nodiscard]] auto beside_windows(bool headless, Work&& work) {
  std::optional<std::invoke_result_t<Work>> result;
  run_beside_windows(headless, [&] { result.emplace(work()); });
  return std::move(*result);
}

/// A window that another thread has asked the main thread for.
class RemoteWindow {
 public:
  /// False where no main thread stands ready.
  [[nodiscard]] static bool is_possible() noexcept;
  /// Waits until it is open.
  /// @return what `Window::open` says.
  [[nodiscard]] static Result<RemoteWindow> open(const Model& model, const std::string& title,
                                                 const WindowOptions& options);
  /// The same; none, which the log tells, where there is no display or no OpenGL, nor where there
  /// is no main thread for it.
  [[nodiscard]] static Result<std::optional<RemoteWindow>> open_where_possible(
      const Model& model, const std::string& title, const WindowOptions& options);
  /// Waits until it is gone.
  ~RemoteWindow();
  RemoteWindow(RemoteWindow&&) noexcept;
  RemoteWindow& operator=(RemoteWindow&&) noexcept;

  [[nodiscard]] ViewLink& link() const;
  /// False once the user closed it or ended the program.
  [[nodiscard]] bool is_open() const { return !link().closed; }

  struct Order;

 private:
  explicit RemoteWindow(std::shared_ptr<Order> order) : order_(std::move(order)) {}
  void close();
  std::shared_ptr<Order> order_;
};

}  // namespace mjarm::view
