#include "mjarm/serve/page_server.hpp"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <exception>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/serve.hpp"
#include "mjarm/serve/connection_internal.hpp"
#include "mjarm/serve/live_messages.hpp"

namespace mjarm::serve {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kTick{16};
constexpr milliseconds kIdleTick{100};  // while there are no pages
constexpr milliseconds kFarewell{500};
constexpr int kPortsTried = 100;    // for a hint at a free one
constexpr double kAllIsDue = 1e18;  // [s] later than any interval of messages

ErrorCode listen_at(tcp::acceptor& acceptor, const tcp::endpoint& at) {
  ErrorCode error;
  acceptor.open(at.protocol(), error);
  if (!error) acceptor.set_option(net::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(at, error);
  if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
  if (error) {
    ErrorCode ignored;
    acceptor.close(ignored);
  }
  return error;
}

/// The next port at which somebody could listen; 0 where there is none near.
int free_port_after(net::io_context& io, tcp::endpoint at, int port) {
  for (int next = port + 1; next <= std::min(port + kPortsTried, 65535); ++next) {
    tcp::acceptor trial(io);
    at.port(static_cast<std::uint16_t>(next));
    if (!listen_at(trial, at)) return next;
  }
  return 0;
}

}  // namespace

struct PageServer::Impl {
  Impl(PageSite& site, LiveFeed* feed, const ServerOptions& options)
      : hub{.site = site, .feed = feed, .options = options} {}
  ~Impl() {
    stop({});
    hub.pages.clear();  // while what their sockets belong to is there
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  Result<void> listen();
  Result<void> start();
  void accept();
  void tick();
  void run();
  void stop(const std::string& why);
  void say_bye(const std::string& why);
  void wait_for_pages(Clock::time_point end);

  Hub hub;
  net::io_context io{1};
  tcp::acceptor acceptor{io};
  net::steady_timer ticker{io};
  net::steady_timer pause{io};  ///< after a connection could not be taken
  net::steady_timer farewell{io};
  int port = 0;
  bool is_stopping = false;  ///< of the server's thread
  std::thread thread = {};
};

Result<void> PageServer::Impl::listen() {
  const ServerOptions& asked = hub.options;
  ErrorCode error;
  const auto address = net::ip::make_address(asked.address, error);
  if (error) return fail(Errc::usage, text(msg::serve_bad_address, asked.address));
  if (asked.port < 0 || asked.port > 65535) {
    return fail(Errc::usage, text(msg::serve_bad_port, asked.port));
  }
  const tcp::endpoint at(address, static_cast<std::uint16_t>(asked.port));
  error = listen_at(acceptor, at);
  if (error == net::error::address_in_use) {
    const int next = free_port_after(io, at, asked.port);
    return fail(Errc::impossible, next == 0 ? text(msg::serve_port_taken, asked.port)
                                            : text(msg::serve_port_taken_but, asked.port, next));
  }
  if (error) {
    return fail(Errc::system,
                text(msg::serve_no_listener, asked.address, asked.port, error.message()));
  }
  port = acceptor.local_endpoint(error).port();
  hub.site.set_port(port);
  return {};
}

Result<void> PageServer::Impl::start() {
  if (Result<void> listening = listen(); !listening) return listening;
  accept();
  tick();
  try {
    thread = std::thread([this] { run(); });
  } catch (const std::system_error& error) {
    return fail(Errc::system, text(msg::serve_no_thread, std::string(error.what())));
  }
  return {};
}

void PageServer::Impl::run() {
  for (;;) {
    try {
      io.run();
      return;
    } catch (const std::exception& error) {  // no memory for a connection: the others go on
      log_warning(error.what());
    }
  }
}

void PageServer::Impl::accept() {
  acceptor.async_accept([this](ErrorCode error, tcp::socket socket) {
    if (is_stopping) return;
    if (error) {  // too many open files, perhaps: no use in asking again at once
      pause.expires_after(kIdleTick);
      pause.async_wait([this](ErrorCode cancelled) {
        if (!cancelled) accept();
      });
      return;
    }
    accept();
    if (hub.connections >= hub.options.max_connections) return;
    ErrorCode ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    take_connection(hub, std::move(socket));
  });
}

void PageServer::Impl::tick() {
  ticker.expires_after(hub.pages.empty() ? kIdleTick : kTick);
  ticker.async_wait([this](ErrorCode error) {
    if (error || is_stopping) return;
    tick();
    if (!hub.pages.empty()) hub.refresh();
    for (const auto& page : std::set(hub.pages)) page->tick();
  });
}

void PageServer::Impl::say_bye(const std::string& why) {
  is_stopping = true;
  ErrorCode ignored;
  acceptor.close(ignored);
  ticker.cancel();
  pause.cancel();
  if (hub.feed != nullptr) hub.feed->refresh(kAllIsDue);
  const auto bye = std::make_shared<const std::string>(bye_message(why));
  for (const auto& page : std::set(hub.pages)) page->say_bye(bye);
  wait_for_pages(Clock::now() + kFarewell);
}

/// Ends as soon as all pages are gone, and after a while in any case.
void PageServer::Impl::wait_for_pages(Clock::time_point end) {
  if (hub.page_count == 0 || Clock::now() >= end) {
    for (const auto& page : hub.pages) page->cut();
    return io.stop();
  }
  farewell.expires_after(milliseconds(5));
  farewell.async_wait([this, end](ErrorCode) { wait_for_pages(end); });
}

void PageServer::Impl::stop(const std::string& why) {
  if (!thread.joinable()) return;
  net::post(io, [this, why] { say_bye(why); });
  thread.join();
}

PageServer::PageServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PageServer::~PageServer() = default;
PageServer::PageServer(PageServer&&) noexcept = default;
PageServer& PageServer::operator=(PageServer&&) noexcept = default;

Result<PageServer> PageServer::start(PageSite& site, LiveFeed* feed, const ServerOptions& options) {
  auto impl = std::make_unique<Impl>(site, feed, options);
  if (Result<void> started = impl->start(); !started) return fail(std::move(started.error()));
  return PageServer(std::move(impl));
}

int PageServer::port() const noexcept { return impl_->port; }
int PageServer::pages() const noexcept { return impl_->hub.page_count; }
void PageServer::stop(const std::string& why) { impl_->stop(why); }

}  // namespace mjarm::serve
