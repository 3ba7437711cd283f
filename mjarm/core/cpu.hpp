#pragma once

#include <string_view>

namespace mjarm {

/// Which vector instructions may be used, from what this machine really has.
enum class SimdLevel {
  baseline,  ///< what every machine of the architecture has (x86-64: SSE2)
  neon,      ///< aarch64
  avx2,      ///< AVX2 and FMA
  avx512,    ///< AVX-512 F, DQ, VL and BW besides
};

/// Highest level of this machine; `MJARM_SIMD=baseline|neon|avx2|avx512` in the environment lowers
/// it (never raises it), for tests and comparisons.
[[nodiscard]] SimdLevel simd_level();

/// "baseline", "neon", "avx2" or "avx512".
[[nodiscard]] std::string_view name(SimdLevel level) noexcept;

}  // namespace mjarm
