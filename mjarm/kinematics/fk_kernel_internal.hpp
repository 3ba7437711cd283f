#pragma once

#include <algorithm>

#include "mjarm/core/simd/functions.hpp"
#include "mjarm/kinematics/fk_batch_internal.hpp"

/// Forward kinematics of as many configurations as a register holds. Included by one file for each
/// width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

using namespace simd;

/// `V` lanes of type `T`: the pose reached, as position and columns of the rotation matrix.
template <class V, class T>
struct LanePose {
  V x[12];

  LanePose() {
    for (int k = 0; k < 12; ++k) x[k] = V{} + T(k >= 3 && k % 4 == 3 ? 1 : 0);
  }

  /// Carries the pose over to a frame at `X`.
  void carry(const Pose& X) {
    const T p[3] = {T(X.p[0]), T(X.p[1]), T(X.p[2])};
    for (int k = 0; k < 3; ++k) x[k] += x[3 + k] * p[0] + x[6 + k] * p[1] + x[9 + k] * p[2];
    for (int k = 0; k < 3; ++k) {
      const V a = x[3 + k], b = x[6 + k], c = x[9 + k];
      for (int j = 0; j < 3; ++j) {
        x[3 + 3 * j + k] = a * T(X.R(0, j)) + b * T(X.R(1, j)) + c * T(X.R(2, j));
      }
    }
  }

  void move(const V& q, bool slide) {
    if (slide) {
      for (int k = 0; k < 3; ++k) x[k] += q * x[9 + k];
      return;
    }
    V s, c;
    sine_cosine(q, s, c);
    for (int k = 0; k < 3; ++k) {
      const V a = x[3 + k];
      x[3 + k] = c * a + s * x[6 + k];
      x[6 + k] = c * x[6 + k] - s * a;
    }
  }
};

template <class V, class T>
void fk_rows(const Chain& chain, const T* q, std::size_t n, T* X) {
  constexpr std::size_t kWidth = sizeof(V) / sizeof(T);
  const auto dof = static_cast<std::size_t>(chain.dof);
  for (std::size_t first = 0; first < n; first += kWidth) {
    const std::size_t count = std::min(kWidth, n - first);
    LanePose<V, T> pose;
    for (std::size_t i = 0; i < dof; ++i) {
      V value;
      for (std::size_t k = 0; k < kWidth; ++k) {
        value[k] = q[(first + std::min(k, count - 1)) * dof + i];
      }
      pose.carry(chain.X_PJ[i]);
      pose.move(value, chain.slide[i]);
    }
    pose.carry(chain.X_JT);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t j = 0; j < 12; ++j) X[12 * (first + k) + j] = pose.x[j][k];
    }
  }
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
