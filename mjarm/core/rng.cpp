#include "mjarm/core/rng.hpp"

#include <bit>
#include <cmath>

namespace mjarm {
namespace {

/// Next value of a splitmix64 sequence.
std::uint64_t splitmix64(std::uint64_t& state) noexcept {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// High and low half of a 64 x 64 bit product, in plain C++ (no 128-bit type needed).
struct Product {
  std::uint64_t high, low;
};
Product multiply(std::uint64_t a, std::uint64_t b) noexcept {
  const std::uint64_t a0 = a & 0xffffffffU, a1 = a >> 32;
  const std::uint64_t b0 = b & 0xffffffffU, b1 = b >> 32;
  const std::uint64_t middle = a1 * b0 + ((a0 * b0) >> 32);
  const std::uint64_t carry = (middle & 0xffffffffU) + a0 * b1;
  return {a1 * b1 + (middle >> 32) + (carry >> 32), a * b};
}

}  // namespace

Rng::Rng(std::uint64_t seed, std::uint64_t stream) noexcept {
  // The stream number is scrambled before it meets the seed: neighbours of either give sequences
  // that have nothing in common. Stream 0 of a seed is plain splitmix64 seeding.
  std::uint64_t mixed = seed;
  if (stream != 0) {
    std::uint64_t scrambled = stream;
    mixed ^= splitmix64(scrambled);
  }
  for (std::uint64_t& word : state_) word = splitmix64(mixed);
}

std::uint64_t Rng::next() noexcept {
  const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
  const std::uint64_t shifted = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Rng::uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Rng::uniform(double lower, double upper) noexcept {
  const double value = lower + (upper - lower) * uniform();
  // Rounding may reach `upper` itself when the range is only a few representable numbers wide.
  return value < upper || !(lower < upper) ? value : std::nextafter(upper, lower);
}

std::uint64_t Rng::below(std::uint64_t n) noexcept {
  Product product = multiply(next(), n);
  if (product.low < n) {
    const std::uint64_t unfair = (0 - n) % n;
    while (product.low < unfair) product = multiply(next(), n);
  }
  return product.high;
}

double Rng::normal() noexcept {
  for (;;) {
    const double u = uniform(-1, 1);
    const double v = uniform(-1, 1);
    const double s = u * u + v * v;
    if (s > 0 && s < 1) return u * std::sqrt(-2 * std::log(s) / s);
  }
}

}  // namespace mjarm
