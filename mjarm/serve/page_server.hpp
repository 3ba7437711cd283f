#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/serve/live_feed.hpp"
#include "mjarm/serve/page_site.hpp"

namespace mjarm::serve {

/// Where a server listens, and what it bears. Every default is usable as is.
struct ServerOptions {
  std::string address = "127.0.0.1";  ///< numeric; another one than a loopback lets others in
  int port = 0;                       ///< 0 to 65535; 0 = any that is free
  int max_pages = 16;                 ///< connections to /live at once, >= 1
  int max_connections = 64;           ///< of any kind at once, >= 1; more are closed at once
  double request_seconds = 10;        ///< [s] for a request of HTTP to arrive, and between two
  double answer_seconds = 60;         ///< [s] for its answer to be taken
  double silent_seconds = 30;         ///< [s] a page that does not even answer pings is dropped
};

/// A small HTTP and WebSocket server for pages that show a simulation, in one thread of its own.
/// Nobody waits for a page: each has at most one message under way, and of what comes meanwhile the
/// newest. Once this object is gone all connections are closed.
class PageServer {
 public:
  /// Listens, and answers from now on.
  /// @param site  used by the thread of the server alone from now on, as the feed; outlives this.
  /// @param feed  none where the site has nothing that lives (`PageSite::add_scene`).
  /// @return usage for an address that is no number or a port that is none; impossible with a port
  ///         that is free where this one is taken; system where the system refuses.
  [[nodiscard]] static Result<PageServer> start(PageSite& site, LiveFeed* feed,
                                                const ServerOptions& options = {});
  /// As `stop`.
  ~PageServer();
  PageServer(PageServer&&) noexcept;
  PageServer& operator=(PageServer&&) noexcept;

  [[nodiscard]] int port() const noexcept;
  /// Pages that are connected now.
  [[nodiscard]] int pages() const noexcept;
  /// Tells all pages that the run is over, waits for them at most half a second, and ends the
  /// thread. Nothing happens the second time.
  void stop(const std::string& why);

 private:
  struct Impl;
  explicit PageServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::serve
