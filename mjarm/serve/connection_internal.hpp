#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <memory>
#include <set>
#include <string>

#include "mjarm/serve/live_feed.hpp"
#include "mjarm/serve/page_server.hpp"
#include "mjarm/serve/page_site.hpp"

/// What the sources of the server share of its connections; all of it belongs to its thread.
namespace mjarm::serve {

namespace net = boost::asio;
using tcp = net::ip::tcp;
using ErrorCode = boost::system::error_code;

/// A page that is connected to /live.
class LivePage {
 public:
  virtual ~LivePage() = default;
  /// New messages may be there, and the page may send more.
  virtual void tick() = 0;
  /// Sends what there is, then the last message, and closes the connection.
  virtual void say_bye(std::shared_ptr<const std::string> bye) = 0;
  /// Ends the connection as it is.
  virtual void cut() = 0;
};

/// What the connections of one server have in common.
struct Hub {
  PageSite& site;
  LiveFeed* feed;  ///< none: there are no pages that live
  ServerOptions options;
  std::atomic<int> page_count{0};  ///< with those that are shaking hands
  int connections = 0;
  std::set<std::shared_ptr<LivePage>> pages = {};  ///< that shook hands
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

  void refresh() {
    if (feed == nullptr) return;
    feed->refresh(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
};

/// One of the connections that a server bears.
class Counted {
 public:
  explicit Counted(Hub& hub) : hub_(hub) { ++hub_.connections; }
  ~Counted() { --hub_.connections; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  Hub& hub_;
};

[[nodiscard]] inline std::chrono::steady_clock::duration clock_seconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

/// Answers what comes over `socket` until it is closed; it may become a page.
void take_connection(Hub& hub, tcp::socket socket);

}  // namespace mjarm::serve
