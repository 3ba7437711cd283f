#include "mjarm/core/cpu.hpp"

#include <optional>
#include <string>

#include "mjarm/core/os.hpp"

namespace mjarm {
namespace {

SimdLevel detect() noexcept {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    return SimdLevel::baseline;
  }
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  return avx512 ? SimdLevel::avx512 : SimdLevel::avx2;
#elif defined(__aarch64__)
  return SimdLevel::neon;
#else
  return SimdLevel::baseline;
#endif
}

}  // namespace

SimdLevel simd_level() {
  static const SimdLevel level = [] {
    const SimdLevel found = detect();
    const std::optional<std::string> wish = environment("MJARM_SIMD");
    for (const SimdLevel lower :
         {SimdLevel::baseline, SimdLevel::neon, SimdLevel::avx2, SimdLevel::avx512}) {
      // NEON and AVX never meet on one machine: only baseline, or a lower AVX, can be asked for.
      const bool same_machine =
          lower == SimdLevel::baseline || (lower == SimdLevel::neon) == (found == SimdLevel::neon);
      if (wish && *wish == name(lower) && same_machine && lower < found) return lower;
    }
    return found;
  }();
  return level;
}

std::string_view name(SimdLevel level) noexcept {
  switch (level) {
    case SimdLevel::baseline:
      return "baseline";
    case SimdLevel::neon:
      return "neon";
    case SimdLevel::avx2:
      return "avx2";
    case SimdLevel::avx512:
      return "avx512";
  }
  return "baseline";
}

}  // namespace mjarm
