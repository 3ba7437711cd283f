#pragma once

#include <chrono>

namespace mjarm {

/// Runs from when it is made.
class Stopwatch {
 public:
  /// [us] since then.
  [[nodiscard]] double us() const noexcept {
    return std::chrono::duration<double, std::micro>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace mjarm
