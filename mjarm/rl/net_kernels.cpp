#include "mjarm/rl/net_kernels_internal.hpp"
#include "mjarm/rl/net_loops_internal.hpp"

namespace mjarm::rl::detail {

const NetKernels kNetBaseline = kLoops;

const NetKernels& net_kernels(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::avx512) return kNetAvx512;
  if (level == SimdLevel::avx2) return kNetAvx2;
#else
  static_cast<void>(level);
#endif
  return kNetBaseline;
}

}  // namespace mjarm::rl::detail
