#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace mjarm::support {

/// What a path of the test server answers, with its faults.
struct Served {
  std::string body;
  std::string type = "application/octet-stream";
  int status = 200;
  bool ranges = true;                  ///< false: Range is ignored, all is sent
  bool silent = false;                 ///< takes the request and never answers
  std::size_t cut_after = SIZE_MAX;    ///< bytes of body after which each connection is closed
  std::size_t announce_more = 0;       ///< added to Content-Length
  std::size_t piece = 65536;           ///< bytes sent at once
  std::chrono::microseconds pause{0};  ///< after each piece
};

/// A small HTTP server on 127.0.0.1, on a port of its own, for tests only.
class HttpServer {
 public:
  /// @throws std::runtime_error where it cannot listen.
  HttpServer();
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] std::string url() const { return "http://127.0.0.1:" + std::to_string(port_); }
  /// What `path` answers from now on; other paths answer 404.
  void serve(const std::string& path, Served served);
  /// Called after each piece with the bytes of bodies sent so far; null: no more.
  void on_sent(std::function<void(std::size_t)> call);
  /// Bytes of bodies sent so far.
  [[nodiscard]] std::size_t sent() const { return sent_; }
  /// The requests so far: "PATH" or "PATH FIRST-LAST".
  [[nodiscard]] std::vector<std::string> requests() const;

 private:
  /// First and last byte, as in a Range header.
  using Range = std::optional<std::pair<std::uint64_t, std::uint64_t>>;
  void accept_all();
  void answer(int client);
  void send_page(int client, const Served& served, const Range& range);
  void send_body(int client, const Served& served, const std::string& body);

  int listener_ = -1;
  int port_ = 0;
  std::atomic<bool> stopping_{false};
  std::atomic<std::size_t> sent_{0};
  mutable std::mutex mutex_;
  std::map<std::string, Served> pages_;
  std::vector<std::string> requests_;
  std::function<void(std::size_t)> on_sent_;
  std::vector<std::thread> workers_;
  std::thread thread_;
};

}  // namespace mjarm::support
