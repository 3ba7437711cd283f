#include "mjarm/core/cpu.hpp"
#include "mjarm/trajectory/retime_kernel_internal.hpp"

namespace mjarm::detail {

double retime_value_baseline(RetimeLanes& lanes, const double* c, double mu) {
  return value_in_lanes(lanes, c, mu);
}
void retime_model_baseline(RetimeLanes& lanes, const double* c, double mu) {
  model_in_lanes(lanes, c, mu);
}

RetimeKernels retime_kernels() noexcept {
#if defined(__x86_64__)
  switch (simd_level()) {
    case SimdLevel::avx512:
      return {retime_value_avx512, retime_model_avx512};
    case SimdLevel::avx2:
      return {retime_value_avx2, retime_model_avx2};
    default:
      break;
  }
#endif
  return {retime_value_baseline, retime_model_baseline};
}

}  // namespace mjarm::detail
