#include "mjarm/core/cpu.hpp"
#include "mjarm/kinematics/general_six_kernel_internal.hpp"

namespace mjarm::detail {

const GeneralKernel& general_kernel_baseline() noexcept { return kGeneralKernel; }

const GeneralKernel& general_kernel() noexcept {
#if defined(__x86_64__)
  switch (simd_level()) {
    case SimdLevel::avx512:
      return general_kernel_avx512();
    case SimdLevel::avx2:
      return general_kernel_avx2();
    default:
      break;
  }
#endif
  return general_kernel_baseline();
}

}  // namespace mjarm::detail
