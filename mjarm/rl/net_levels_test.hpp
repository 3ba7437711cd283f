#pragma once

#include <vector>

#include "mjarm/rl/net_kernels_internal.hpp"

namespace mjarm::testing {

using namespace rl;

/// Those of all levels that this machine runs and MJARM_SIMD allows.
inline std::vector<const rl::detail::NetKernels*> all_net_kernels() {
  std::vector<const rl::detail::NetKernels*> all = {&rl::detail::kNetBaseline};
#if defined(__x86_64__)
  if (simd_level() >= SimdLevel::avx2) all.push_back(&rl::detail::kNetAvx2);
  if (simd_level() >= SimdLevel::avx512) all.push_back(&rl::detail::kNetAvx512);
#endif
  return all;
}

}  // namespace mjarm::testing
