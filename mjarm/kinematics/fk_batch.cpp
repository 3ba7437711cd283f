#include "mjarm/kinematics/fk_batch.hpp"

#include <cassert>

#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/fk_kernel_internal.hpp"

namespace mjarm {
namespace detail {

const FkKernels kFkBaseline = {fk_rows<Doubles, double>, fk_rows<Floats, float>};

const FkKernels& fk_kernels() noexcept {
#if defined(__x86_64__)
  switch (simd_level()) {
    case SimdLevel::avx512:
      return kFkAvx512;
    case SimdLevel::avx2:
      return kFkAvx2;
    default:
      break;
  }
#endif
  return kFkBaseline;
}

}  // namespace detail

void fk_batch(const Chain& chain, std::span<const double> q, std::span<Pose> X_WT) noexcept {
  static_assert(sizeof(Pose) == 12 * sizeof(double));
  assert(q.size() == X_WT.size() * static_cast<std::size_t>(chain.dof));
  if (X_WT.empty()) return;
  detail::fk_kernels().doubles(chain, q.data(), X_WT.size(), X_WT.front().p.data());
}

void fk_batch(const Chain& chain, std::span<const float> q, std::span<float> X_WT) noexcept {
  const std::size_t n = X_WT.size() / 12;
  assert(q.size() == n * static_cast<std::size_t>(chain.dof));
  if (n > 0) detail::fk_kernels().floats(chain, q.data(), n, X_WT.data());
}

}  // namespace mjarm
