#include <array>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "mjarm/serve/connection_internal.hpp"
#include "mjarm/serve/live_page_internal.hpp"

namespace mjarm::serve {
namespace {

constexpr std::size_t kMaxHeader = 8 * 1024;  // [bytes] of a request

/// A connection of HTTP, which may become a page.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Hub& hub, tcp::socket socket) : hub_(hub), counted_(hub), stream_(std::move(socket)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kMaxHeader);
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is read
    stream_.expires_after(clock_seconds(hub_.options.request_seconds));
    http::async_read_header(stream_, in_, *parser_,
                            [self = shared_from_this()](ErrorCode error, std::size_t) {
                              error ? self->refuse(error) : self->answer();
                            });
  }

 private:
  /// A request that cannot be read is answered where somebody is there, and its connection closed.
  void refuse(ErrorCode error) {
    if (parser_->is_header_done()) return answer();  // a body, which nobody reads
    if (error.category() != http::make_error_code(http::error::end_of_stream).category() ||
        error == http::error::end_of_stream || error == http::error::partial_message) {
      return close();
    }
    const bool is_long =
        error == http::error::header_limit || error == http::error::buffer_overflow;
    keep_alive_ = false;
    is_head_ = false;
    answer_ = hub_.site.refusal(is_long ? 431 : 400);
    write();
  }

  void answer() {
    const http::request<http::empty_body>& request = parser_->get();
    const auto word = [&request](http::field field) -> std::string_view {
      if (request.count(field) > 1) return {};
      const auto value = request[field];
      return {value.data(), value.size()};
    };
    const auto method = request.method_string();
    const auto target = request.target();
    SiteRequest asked{.method = {method.data(), method.size()},
                      .target = {target.data(), target.size()},
                      .host = word(http::field::host),
                      .if_none_match = word(http::field::if_none_match),
                      .upgrade = websocket::is_upgrade(request)};
    if (request.count(http::field::origin) > 0) {
      asked.origin = word(http::field::origin);
    }
    answer_ = hub_.site.answer(asked);
    if (answer_.is_live) {
      if (hub_.page_count < hub_.options.max_pages) return become_page(request);
      answer_ = hub_.site.refusal(503);
    }
    is_head_ = request.method() == http::verb::head;
    const bool has_body = parser_->chunked() || parser_->content_length_remaining().value_or(0) > 0;
    keep_alive_ = request.keep_alive() && !has_body && answer_.status != 503;
    write();
  }

  void become_page(const http::request<http::empty_body>& request) {
    start_page(hub_, stream_.release_socket(), request, answer_);
  }

  void write() {
    head_ = "HTTP/1.1 " + std::to_string(answer_.status) + " ";
    const auto reason = http::obsolete_reason(static_cast<http::status>(answer_.status));
    head_.append(reason.data(), reason.size());
    for (const auto& [name, value] : answer_.headers) {
      head_.append("\r\n").append(name).append(": ").append(value);
    }
    if (answer_.status != 304) {
      head_ += "\r\nContent-Length: " + std::to_string(answer_.body->size());
    }
    head_ += keep_alive_ ? "\r\n\r\n" : "\r\nConnection: close\r\n\r\n";
    const std::array<net::const_buffer, 2> parts = {
        net::buffer(head_), is_head_ ? net::const_buffer() : net::buffer(*answer_.body)};
    stream_.expires_after(clock_seconds(hub_.options.answer_seconds));
    net::async_write(stream_, parts, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error || !self->keep_alive_) return self->close();
      self->read();
    });
  }

  void close() {
    ErrorCode ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  Hub& hub_;
  Counted counted_;
  beast::tcp_stream stream_;
  beast::flat_buffer in_{2 * kMaxHeader};
  std::optional<http::request_parser<http::empty_body>> parser_ = {};
  SiteAnswer answer_ = {};
  std::string head_ = {};
  bool is_head_ = false;
  bool keep_alive_ = false;
};

}  // namespace

void take_connection(Hub& hub, tcp::socket socket) {
  std::make_shared<Connection>(hub, std::move(socket))->read();
}

}  // namespace mjarm::serve
