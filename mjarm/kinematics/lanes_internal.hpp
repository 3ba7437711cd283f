#pragma once

#include <cmath>
#include <numbers>

#include "mjarm/kinematics/block_internal.hpp"

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

/// A few doubles at a time, as wide as the file that includes this header is compiled for. Each
/// width has its own namespace, so that the three copies of a kernel never meet. Blocks are of
/// kBlock lanes everywhere: what is computed does not depend on the width but for rounding.
namespace mjarm::detail {

#if defined(__AVX512F__)
#define MJARM_LANES lanes_avx512
inline namespace MJARM_LANES {
inline constexpr int kLanes = 8;
#elif defined(__AVX2__)
#define MJARM_LANES lanes_avx2
inline namespace MJARM_LANES {
inline constexpr int kLanes = 4;
#else
#define MJARM_LANES lanes_baseline
inline namespace MJARM_LANES {
inline constexpr int kLanes = 2;
#endif

typedef double Lanes __attribute__((vector_size(8 * kLanes)));
using LaneMask = decltype(Lanes{} < Lanes{});  ///< -1: true, 0: false

inline Lanes splat(double x) { return Lanes{} + x; }

inline Lanes load(const double* from) {
  Lanes out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}

inline void store(double* to, const Lanes& x) { __builtin_memcpy(to, &x, sizeof x); }

inline Lanes square_root(const Lanes& x) {
#if defined(__AVX512F__)
  return (Lanes)_mm512_mask_sqrt_pd((__m512d)x, 0xff, (__m512d)x);
#elif defined(__AVX2__)
  return (Lanes)_mm256_sqrt_pd((__m256d)x);
#elif defined(__SSE2__)
  return (Lanes)_mm_sqrt_pd((__m128d)x);
#else
  Lanes out = x;
  for (int k = 0; k < kLanes; ++k) out[k] = std::sqrt(x[k]);
  return out;
#endif
}

inline Lanes select(const LaneMask& where, const Lanes& yes, const Lanes& no) {
  return where ? yes : no;
}
inline Lanes smaller(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }
inline Lanes larger(const Lanes& a, const Lanes& b) { return select(a > b, a, b); }

/// Sine and cosine for |x| < 1e5, to 1e-15: the argument is reduced to a quarter turn by three
/// parts of pi/2 (W. J. Cody and W. Waite, 1980), then Taylor's series.
inline void sine_cosine(const Lanes& x, Lanes& s, Lanes& c) {
  constexpr double kMagic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number
  const Lanes shifted = x * (2 / std::numbers::pi) + kMagic;
  const Lanes n = shifted - kMagic;
  Lanes r = x - n * 1.5707963267341256;  // the first 33 bits of pi/2, the next 33, the rest
  r = r - n * 6.0771005063039660e-11;
  r = r - n * 2.0222662487959506e-21;
  const Lanes z = r * r;
  Lanes a = splat(-1.0 / 1307674368000);
  a = a * z + 1.0 / 6227020800;
  a = a * z - 1.0 / 39916800;
  a = a * z + 1.0 / 362880;
  a = a * z - 1.0 / 5040;
  a = a * z + 1.0 / 120;
  a = a * z - 1.0 / 6;
  a = r + r * z * a;
  Lanes b = splat(1.0 / 20922789888000);
  b = b * z - 1.0 / 87178291200;
  b = b * z + 1.0 / 479001600;
  b = b * z - 1.0 / 3628800;
  b = b * z + 1.0 / 40320;
  b = b * z - 1.0 / 720;
  b = b * z + 1.0 / 24;
  b = 1.0 - 0.5 * z + z * z * b;
  LaneMask quarter;
  __builtin_memcpy(&quarter, &shifted, sizeof quarter);
  const LaneMask odd = -(quarter & 1);
  const LaneMask sine_sign = (quarter & 2) << 62;
  const LaneMask cosine_sign = ((quarter + 1) & 2) << 62;
  const Lanes s0 = select(odd, b, a);
  const Lanes c0 = select(odd, a, b);
  LaneMask bits;
  __builtin_memcpy(&bits, &s0, sizeof bits);
  bits ^= sine_sign;
  __builtin_memcpy(&s, &bits, sizeof bits);
  __builtin_memcpy(&bits, &c0, sizeof bits);
  bits ^= cosine_sign;
  __builtin_memcpy(&c, &bits, sizeof bits);
}

typedef float FloatLanes __attribute__((vector_size(8 * kLanes)));  ///< twice as many

/// Sine and cosine for |x| < 100, to 1e-6; as above.
inline void sine_cosine(const FloatLanes& x, FloatLanes& s, FloatLanes& c) {
  using Mask = decltype(x < x);
  constexpr float kMagic = 12582912.0F;  // 1.5 * 2^23
  const FloatLanes shifted = x * static_cast<float>(2 / std::numbers::pi) + kMagic;
  const FloatLanes n = shifted - kMagic;
  FloatLanes r = x - n * 1.5703125F;  // the first 8 bits of pi/2, the next 11, the rest
  r = r - n * 4.837512969970703e-4F;
  r = r - n * 7.549789954891882e-8F;
  const FloatLanes z = r * r;
  FloatLanes a = FloatLanes{} + 1.0F / 362880;
  a = a * z - 1.0F / 5040;
  a = a * z + 1.0F / 120;
  a = a * z - 1.0F / 6;
  a = r + r * z * a;
  FloatLanes b = FloatLanes{} + 1.0F / 40320;
  b = b * z - 1.0F / 720;
  b = b * z + 1.0F / 24;
  b = 1.0F - 0.5F * z + z * z * b;
  Mask quarter;
  __builtin_memcpy(&quarter, &shifted, sizeof quarter);
  const Mask odd = -(quarter & 1);
  const FloatLanes s0 = odd ? b : a;
  const FloatLanes c0 = odd ? a : b;
  Mask bits;
  __builtin_memcpy(&bits, &s0, sizeof bits);
  bits ^= (quarter & 2) << 30;
  __builtin_memcpy(&s, &bits, sizeof bits);
  __builtin_memcpy(&bits, &c0, sizeof bits);
  bits ^= ((quarter + 1) & 2) << 30;
  __builtin_memcpy(&c, &bits, sizeof bits);
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
