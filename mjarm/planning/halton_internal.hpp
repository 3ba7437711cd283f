#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::detail {

/// Points that fill the unit cube evenly: the Halton sequence, one prime a coordinate, moved by a
/// random offset round the cube (R. Cranley and T. N. L. Patterson, SIAM J. Numer. Anal. 13 (1976)
/// 904).
class Halton {
 public:
  Halton(std::size_t dof, Rng& rng) : dof_(dof) {
    for (std::size_t k = 0; k < dof; ++k) shift_[k] = rng.uniform();
  }

  /// Writes the next point, shape (dof,).
  void next(double* out) {
    ++index_;
    for (std::size_t k = 0; k < dof_; ++k) {
      const double x = inverse(index_, kPrimes[k]) + shift_[k];
      out[k] = x < 1 ? x : x - 1;
    }
  }

 private:
  static constexpr std::array<std::uint32_t, kMaxDof> kPrimes{2,  3,  5,  7,  11, 13, 17, 19,
                                                              23, 29, 31, 37, 41, 43, 47, 53};

  /// The digits of `i` in base `base`, mirrored at the point.
  static double inverse(std::uint32_t i, std::uint32_t base) {
    double out = 0, digit = 1.0 / base;
    for (; i > 0; i /= base, digit /= base) out += digit * (i % base);
    return out;
  }

  std::size_t dof_;
  std::uint32_t index_ = 0;
  std::array<double, kMaxDof> shift_{};
};

}  // namespace mjarm::detail
