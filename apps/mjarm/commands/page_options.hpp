#pragma once

#include <functional>
#include <optional>
#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/serve/show_in_page.hpp"
#include "mjarm/view/recorded_run.hpp"
#include "mjarm/view/remote_window.hpp"

namespace mjarm::app {

/// Where a page is served, as the user wrote it.
struct ServeArguments {
  std::string address, port;
};
void add_serve_options(CLI::App& app, ServeArguments& arguments);
/// @return usage for what is no port; the address is told once it is served.
[[nodiscard]] Result<serve::PageOptions> read_serve_options(const ServeArguments& arguments);

/// How a run is seen in a browser, as the user wrote it.
struct RunPageArguments {
  bool serve = false;     ///< while it runs, in the place of a window
  std::string port = {};  ///< of that
  std::string html = {};  ///< afterwards: a file
};
void add_run_page_options(CLI::App& app, RunPageArguments& arguments);

/// How a run is seen in a browser.
struct RunPages {
  std::optional<serve::PageOptions> page = {};
  view::RunKeeper record = {};
};
/// @param waits  a run that is served begins once somebody looks.
/// @return usage for options that would do nothing, and for a file that is no .html; not_available
///         where the page is not installed: before anything runs.
[[nodiscard]] Result<RunPages> read_run_pages(const RunPageArguments& arguments, bool headless,
                                              bool waits = true);

/// Runs `work` while this thread, the main thread, shows what it asks for: in a page, in a window,
/// or, where that is not wanted, not at all.
template <class Work>
[[nodiscard]] auto beside_what_shows(const RunPages& pages, bool headless, Work&& work) {
  if (!pages.page) return view::beside_windows(headless, std::forward<Work>(work));
  std::optional<std::invoke_result_t<Work>> result;
  view::run_beside(serve::page_shower(*pages.page), [&] { result.emplace(work()); });
  return std::move(*result);
}

}  // namespace mjarm::app
