#include "tests/support/http_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace mjarm::support {
namespace {

std::string read_request(int client) {
  std::string request;
  char buffer[4096];
  while (request.find("\r\n\r\n") == std::string::npos) {
    const ssize_t count = recv(client, buffer, sizeof buffer, 0);
    if (count <= 0) return {};
    request.append(buffer, static_cast<std::size_t>(count));
  }
  return request;
}

}  // namespace

HttpServer::HttpServer() {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* raw = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener_, raw, size) != 0 || listen(listener_, 16) != 0 ||
      getsockname(listener_, raw, &size) != 0) {
    throw std::runtime_error("the test server cannot listen on 127.0.0.1");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { accept_all(); });
}

HttpServer::~HttpServer() {
  stopping_ = true;
  shutdown(listener_, SHUT_RDWR);
  thread_.join();
  close(listener_);
  for (std::thread& worker : workers_) worker.join();
}

void HttpServer::serve(const std::string& path, Served served) {
  const std::lock_guard lock(mutex_);
  pages_[path] = std::move(served);
}

void HttpServer::on_sent(std::function<void(std::size_t)> call) {
  const std::lock_guard lock(mutex_);
  on_sent_ = std::move(call);
}

std::vector<std::string> HttpServer::requests() const {
  const std::lock_guard lock(mutex_);
  return requests_;
}

void HttpServer::accept_all() {
  while (!stopping_) {
    const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client < 0) return;
    workers_.emplace_back([this, client] {
      answer(client);
      shutdown(client, SHUT_RDWR);
      close(client);
    });
  }
}

void HttpServer::answer(int client) {
  const std::string request = read_request(client);
  char path[1024] = "";
  if (std::sscanf(request.c_str(), "GET %1023s", path) != 1) return;
  Range range;
  unsigned long long first = 0, last = 0;
  const std::size_t header = request.find("Range: bytes=");
  if (header != std::string::npos &&
      std::sscanf(request.c_str() + header, "Range: bytes=%llu-%llu", &first, &last) == 2) {
    range.emplace(first, last);
  }
  Served served{.body = "no such page", .status = 404};
  {
    const std::lock_guard lock(mutex_);
    const std::string asked = std::to_string(first) + "-" + std::to_string(last);
    requests_.push_back(path + (range ? " " + asked : ""));
    if (const auto page = pages_.find(path); page != pages_.end()) served = page->second;
  }
  while (served.silent && !stopping_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (!served.silent) send_page(client, served, range);
}

void HttpServer::send_page(int client, const Served& served, const Range& range) {
  std::string head = "HTTP/1.1 " + std::to_string(served.status) + " Status\r\n";
  std::string body = served.body;
  const bool part = range && served.ranges && served.status == 200;
  if (part && range->first >= body.size()) {
    head = "HTTP/1.1 416 Range Not Satisfiable\r\n";
    body.clear();
  } else if (part) {
    const std::size_t last = std::min<std::size_t>(range->second, body.size() - 1);
    head = "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes " + std::to_string(range->first) +
           "-" + std::to_string(last) + "/" + std::to_string(body.size()) + "\r\n";
    body = body.substr(range->first, last - range->first + 1);
  }
  head += "Content-Type: " + served.type +
          "\r\nContent-Length: " + std::to_string(body.size() + served.announce_more) +
          "\r\nConnection: close\r\n\r\n";
  if (send(client, head.data(), head.size(), MSG_NOSIGNAL) >= 0) send_body(client, served, body);
}

void HttpServer::send_body(int client, const Served& served, const std::string& body) {
  const std::size_t end = std::min(body.size(), served.cut_after);
  for (std::size_t at = 0; at < end && !stopping_;) {
    const std::size_t size = std::min(served.piece, end - at);
    sent_ += size;  // before, so that whoever has the bytes sees them counted
    if (send(client, body.data() + at, size, MSG_NOSIGNAL) != static_cast<ssize_t>(size)) {
      sent_ -= size;
      return;
    }
    at += size;
    {
      const std::lock_guard lock(mutex_);
      if (on_sent_) on_sent_(sent_);
    }
    if (served.pause.count() > 0) std::this_thread::sleep_for(served.pause);
  }
}

}  // namespace mjarm::support
