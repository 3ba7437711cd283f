#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace mjarm {

/// SHA-256 as content comes, piece by piece: that of OpenSSL on Linux, our own on Windows, which
/// brings no OpenSSL along.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view piece);
  /// Of all that was added, 32 bytes. Call once, last.
  [[nodiscard]] std::string bytes();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mjarm
