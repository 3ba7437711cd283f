#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/seven_axis_kernel_internal.hpp"

namespace mjarm::detail {

void seven_block_baseline(const SevenGeometry& geometry, const SevenGoal& goal, const double* q7,
                          SevenBlock& out) {
  seven_block(geometry, goal, q7, out);
}

SevenKernel seven_kernel() noexcept {
#if defined(__x86_64__)
  switch (simd_level()) {
    case SimdLevel::avx512:
      return seven_block_avx512;
    case SimdLevel::avx2:
      return seven_block_avx2;
    default:
      break;
  }
#endif
  return seven_block_baseline;
}

}  // namespace mjarm::detail
