#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/descent_kernel_internal.hpp"

namespace mjarm::detail {

void descent_step_baseline(const Chain& chain, const Pose& X_WT, const DescentOptions& options,
                           DescentBlock& block) {
  descent_step(chain, X_WT, options, block);
}

DescentKernel descent_kernel() noexcept {
#if defined(__x86_64__)
  switch (simd_level()) {
    case SimdLevel::avx512:
      return descent_step_avx512;
    case SimdLevel::avx2:
      return descent_step_avx2;
    default:
      break;
  }
#endif
  return descent_step_baseline;
}

}  // namespace mjarm::detail
