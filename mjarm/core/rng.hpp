#pragma once

#include <array>
#include <cstdint>

namespace mjarm {

/// Random numbers that are the same on every machine: xoshiro256** seeded by splitmix64
/// (D. Blackman and S. Vigna, ACM TOMS 47 (2021) 36). Passed in wherever randomness is used.
class Rng {
 public:
  /// `stream` separates independent sequences of one seed (one a thread, one an environment).
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0) noexcept;
  /// Goes on where another one with this state() stood; not all words may be 0.
  explicit Rng(const std::array<std::uint64_t, 4>& state) noexcept : state_(state) {}
  /// Everything that decides what comes next.
  [[nodiscard]] const std::array<std::uint64_t, 4>& state() const noexcept { return state_; }
  /// 64 random bits.
  std::uint64_t next() noexcept;
  /// Uniform in [0, 1).
  double uniform() noexcept;
  /// Uniform in [lower, upper); `lower` where both are equal.
  double uniform(double lower, double upper) noexcept;
  /// Uniform integer in [0, n), n > 0, without bias (D. Lemire, ACM TOMACS 29 (2019) 3).
  std::uint64_t below(std::uint64_t n) noexcept;
  /// Standard normal (Marsaglia's polar method, no state kept between calls).
  double normal() noexcept;

 private:
  std::array<std::uint64_t, 4> state_;
};

}  // namespace mjarm
