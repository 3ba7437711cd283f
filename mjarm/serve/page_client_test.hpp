#pragma once

#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/json.hpp"

/// What plays the browser in tests of the server. Nothing waits for longer than ten seconds.
namespace mjarm::testing {

using ErrorCode = boost::system::error_code;
using Tcp = boost::asio::ip::tcp;

/// An answer of HTTP.
struct Answer {
  int status = 0;  ///< 0: there was none
  std::string body = {};
  std::string etag = {};
  std::string policy = {};
  std::string length = {};
};

class Client {
 public:
  explicit Client(int port) : port_(port) {
    auto& stream = boost::beast::get_lowest_layer(socket_);
    ErrorCode error;
    stream.socket().connect(
        {boost::asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(port)}, error);
    EXPECT_FALSE(error) << error.message();
  }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  /// The socket itself, for whoever does not behave.
  Tcp::socket& raw() { return boost::beast::get_lowest_layer(socket_).socket(); }

  Answer request(const std::string& target, const std::string& method = "GET",
                 std::vector<std::pair<std::string, std::string>> headers = {},
                 const std::string& body = {}) {
    namespace http = boost::beast::http;
    http::request<http::string_body> asked;
    asked.method_string(method);
    asked.target(target);
    asked.version(11);
    asked.set(http::field::host, host());
    for (const auto& [name, value] : headers) asked.set(name, value);
    asked.body() = body;
    if (!body.empty()) asked.prepare_payload();
    http::response_parser<http::string_body> parser;
    parser.skip(method == "HEAD");
    boost::beast::flat_buffer buffer;
    auto& stream = boost::beast::get_lowest_layer(socket_);
    if (finish([&](auto done) { http::async_write(stream, asked, done); })) return {};
    parser.body_limit(boost::none);
    if (finish([&](auto done) { http::async_read(stream, buffer, parser, done); })) return {};
    const auto& got = parser.get();
    return {static_cast<int>(got.result_int()), got.body(), std::string(got[http::field::etag]),
            std::string(got["Content-Security-Policy"]),
            std::string(got[http::field::content_length])};
  }

  /// Becomes a page.
  ErrorCode open(const std::string& target, const std::string& origin = {},
                 const std::string& named = {}) {
    namespace websocket = boost::beast::websocket;
    socket_.set_option(websocket::stream_base::decorator([origin](websocket::request_type& asked) {
      if (!origin.empty()) asked.set(boost::beast::http::field::origin, origin);
    }));
    return finish(
        [&](auto done) { socket_.async_handshake(named.empty() ? host() : named, target, done); });
  }
  ErrorCode send(const std::string& text, bool is_text = true) {
    socket_.text(is_text);
    return finish([&](auto done) { socket_.async_write(boost::asio::buffer(text), done); });
  }
  /// The next message; none where the connection is closed.
  std::optional<std::string> receive() {
    buffer_.clear();
    if (finish([&](auto done) { socket_.async_read(buffer_, done); })) return std::nullopt;
    return boost::beast::buffers_to_string(buffer_.data());
  }
  [[nodiscard]] bool got_frame() const { return socket_.got_binary(); }
  /// The next message of this type; none where the connection is closed before.
  std::optional<std::string> receive(const std::string& type) {
    for (int i = 0; i < 10'000; ++i) {
      std::optional<std::string> message = receive();
      if (!message) return std::nullopt;
      if (type == "frame" ? got_frame()
                          : !got_frame() && message->starts_with("{\"type\":\"" + type + "\"")) {
        return message;
      }
    }
    return std::nullopt;
  }
  [[nodiscard]] int close_code() const { return socket_.reason().code; }
  void vanish() {
    ErrorCode ignored;
    raw().set_option(boost::asio::socket_base::linger(true, 0), ignored);
    raw().close(ignored);
  }

 private:
  template <class Start>
  ErrorCode finish(const Start& start) {
    std::optional<ErrorCode> result;
    start([&result](ErrorCode error, auto...) { result = error; });
    io_.restart();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!result && std::chrono::steady_clock::now() < end) {
      io_.run_one_for(std::chrono::milliseconds(100));
    }
    if (!result) {
      vanish();
      io_.restart();
      io_.run();
      ADD_FAILURE() << "ten seconds went by";
    }
    return *result;
  }

  int port_;
  boost::asio::io_context io_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_{io_};
  boost::beast::flat_buffer buffer_;
};

}  // namespace mjarm::testing
