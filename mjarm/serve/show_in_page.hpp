#pragma once

#include <functional>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/serve/page_server.hpp"
#include "mjarm/view/remote_window.hpp"
#include "mjarm/view/target_link.hpp"
#include "mjarm/view/view_link.hpp"
#include "mjarm/view/window.hpp"

namespace mjarm::serve {

/// How a page is served. Every default is usable as is.
struct PageOptions {
  ServerOptions server = {};
  /// Names the folder of the page: 32 lower-case hexadecimal digits, which only who may come in
  /// knows. Empty = new ones of the operating system.
  std::string token = {};
  double seconds = 0;                  ///< [s] ends by itself after so long; 0 = never
  view::TargetLink* target = nullptr;  ///< of the tool; none = there is no target
  bool turns = true;                   ///< the target has rings
  bool waits = false;                  ///< `page_shower`: what is shown begins once somebody looks
  /// Called with the address to be opened, once the server answers; may be empty.
  std::function<void(const std::string& url)> on_open = {};
};

/// Serves a page that shows what `simulate` hands over, which runs in a thread of its own, until
/// Ctrl-C (`interrupted()`) or `options.seconds`; then `link.closed` is set and `simulate` has to
/// return. As `view::show_in_window`, and with the same options as far as a page has them: pause,
/// camera, and what the application lets the user do.
/// @return what `PageServer::start` says; bad_input for a camera the model does not have; usage for
///         a token that is none.
[[nodiscard]] Result<void> show_in_page(const Model& model, const std::string& title,
                                        const view::WindowOptions& window,
                                        const PageOptions& options,
                                        const std::function<void(view::ViewLink&)>& simulate);

/// Serves the page of a recorded run (`run_page`) until Ctrl-C or `options.seconds`.
/// @return what `PageServer::start` says.
[[nodiscard]] Result<void> show_run_page(std::string html, const PageOptions& options);

/// A page in the place of each window that work asks for: `view::run_beside(page_shower(...),
/// work)` instead of `view::run_beside_windows(...)`. One window after the other has its page, at
/// the same address where the options name port and token.
[[nodiscard]] view::Shower page_shower(const PageOptions& options);

}  // namespace mjarm::serve
