#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

/// A few floats at a time, as wide as the file that includes this header is compiled for. Each
/// width has its own namespace, so that the copies of a kernel never meet.
namespace mjarm::detail {

/// Largest error of sine_cosine() below, for |x| <= kMaxAngle: the reduced angle is right to 3e-8
/// (three parts of pi/2, the first of 8 and the second of 11 bits, so that their products with the
/// number of quarters are exact), Taylor's tails are below 3e-8, and what is left are roundings.
inline constexpr double kTrigError = 3e-7;
inline constexpr double kMaxAngle = 100;  ///< [rad]

#if defined(__AVX512F__)
#define MJARM_FLOAT_LANES float_lanes_avx512
inline namespace MJARM_FLOAT_LANES {
inline constexpr int kWidth = 16;
#elif defined(__AVX2__)
#define MJARM_FLOAT_LANES float_lanes_avx2
inline namespace MJARM_FLOAT_LANES {
inline constexpr int kWidth = 8;
#else
#define MJARM_FLOAT_LANES float_lanes_baseline
inline namespace MJARM_FLOAT_LANES {
inline constexpr int kWidth = 4;
#endif

typedef float Floats __attribute__((vector_size(4 * kWidth)));
typedef std::int32_t Ints __attribute__((vector_size(4 * kWidth)));

/// One bit a lane, lane 0 lowest.
using LaneBits = std::uint32_t;
inline constexpr LaneBits kAllLanes = (LaneBits{1} << kWidth) - 1;

inline Floats load(const float* from) {
  Floats out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}

inline void store(float* to, const Floats& x) { __builtin_memcpy(to, &x, sizeof x); }

typedef float Quad __attribute__((vector_size(16)));

/// kWidth / 4 of them side by side.
inline Floats joined(const Quad* from) {
#if defined(__AVX512F__)
  const auto low = __builtin_shufflevector(from[0], from[1], 0, 1, 2, 3, 4, 5, 6, 7);
  const auto high = __builtin_shufflevector(from[2], from[3], 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#elif defined(__AVX2__)
  return __builtin_shufflevector(from[0], from[1], 0, 1, 2, 3, 4, 5, 6, 7);
#else
  return from[0];
#endif
}

// Splats by intrinsics read memory as they spread it; a sum with zero would be worked out.
#if defined(__AVX512F__)
inline Floats splat(float x) { return (Floats)_mm512_set1_ps(x); }
inline Floats multiply_add(Floats a, Floats b, Floats c) {
  return (Floats)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
}
// The masked forms, as the plain ones trip a warning of GCC 12 about their undefined source.
inline Floats smaller(Floats a, Floats b) {
  return (Floats)_mm512_maskz_min_ps(0xffff, (__m512)a, (__m512)b);
}
inline Floats larger(Floats a, Floats b) {
  return (Floats)_mm512_maskz_max_ps(0xffff, (__m512)a, (__m512)b);
}
inline Floats square_root(Floats x) { return (Floats)_mm512_maskz_sqrt_ps(0xffff, (__m512)x); }
inline LaneBits less(Floats a, Floats b) {
  return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
}
inline Floats zero_where(LaneBits lanes, Floats x) {
  return (Floats)_mm512_maskz_mov_ps(static_cast<__mmask16>(~lanes), (__m512)x);
}
#elif defined(__AVX2__)
inline Floats splat(float x) { return (Floats)_mm256_set1_ps(x); }
inline Floats multiply_add(Floats a, Floats b, Floats c) {
  return (Floats)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
}
inline Floats smaller(Floats a, Floats b) { return (Floats)_mm256_min_ps((__m256)a, (__m256)b); }
inline Floats larger(Floats a, Floats b) { return (Floats)_mm256_max_ps((__m256)a, (__m256)b); }
inline Floats square_root(Floats x) { return (Floats)_mm256_sqrt_ps((__m256)x); }
inline LaneBits less(Floats a, Floats b) {
  return static_cast<LaneBits>(_mm256_movemask_ps(_mm256_cmp_ps((__m256)a, (__m256)b, _CMP_LT_OQ)));
}
#elif defined(__SSE2__)
inline Floats splat(float x) { return (Floats)_mm_set1_ps(x); }
inline Floats multiply_add(Floats a, Floats b, Floats c) { return a * b + c; }
inline Floats smaller(Floats a, Floats b) { return (Floats)_mm_min_ps((__m128)a, (__m128)b); }
inline Floats larger(Floats a, Floats b) { return (Floats)_mm_max_ps((__m128)a, (__m128)b); }
inline Floats square_root(Floats x) { return (Floats)_mm_sqrt_ps((__m128)x); }
inline LaneBits less(Floats a, Floats b) {
  return static_cast<LaneBits>(_mm_movemask_ps(_mm_cmplt_ps((__m128)a, (__m128)b)));
}
#else
inline Floats splat(float x) { return Floats{} + x; }
inline Floats multiply_add(Floats a, Floats b, Floats c) { return a * b + c; }
inline Floats smaller(Floats a, Floats b) { return a < b ? a : b; }
inline Floats larger(Floats a, Floats b) { return a > b ? a : b; }
inline Floats square_root(Floats x) {
  Floats out = x;
  for (int k = 0; k < kWidth; ++k) out[k] = std::sqrt(x[k]);
  return out;
}
inline LaneBits less(Floats a, Floats b) {
  const Ints where = a < b;
  LaneBits out = 0;
  for (int k = 0; k < kWidth; ++k) out |= (where[k] != 0 ? LaneBits{1} : 0) << k;
  return out;
}
#endif

#if !defined(__AVX512F__)
inline Floats zero_where(LaneBits lanes, Floats x) {
  Ints bit;
  for (int k = 0; k < kWidth; ++k) bit[k] = 1 << k;
  const Ints chosen = (Ints{} + static_cast<std::int32_t>(lanes)) & bit;
  return chosen == 0 ? x : Floats{};
}
#endif

/// One byte a lane; three more behind the last may be read.
#if defined(__AVX512F__)
inline Ints gather(const std::uint8_t* from, Ints index) {
  return (Ints)_mm512_mask_i32gather_epi32(__m512i{}, 0xffff, (__m512i)index, from, 1) & 0xff;
}
#elif defined(__AVX2__)
inline Ints gather(const std::uint8_t* from, Ints index) {
  return (Ints)_mm256_i32gather_epi32(reinterpret_cast<const int*>(from), (__m256i)index, 1) & 0xff;
}
#else
inline Ints gather(const std::uint8_t* from, Ints index) {
  Ints out;
  for (int k = 0; k < kWidth; ++k) out[k] = from[index[k]];
  return out;
}
#endif

/// Sine and cosine for |x| <= kMaxAngle, to kTrigError: the argument is reduced to a quarter turn
/// by three parts of pi/2 (W. J. Cody and W. Waite, 1980), then Taylor's series.
inline void sine_cosine(Floats x, Floats& s, Floats& c) {
  constexpr float kMagic = 12582912.0F;  // 1.5 * 2^23: adding it rounds to a whole number
  const Floats shifted =
      multiply_add(x, splat(static_cast<float>(2 / std::numbers::pi)), splat(kMagic));
  const Floats n = shifted - kMagic;
  Floats r = multiply_add(n, splat(-1.5703125F), x);
  r = multiply_add(n, splat(-4.837512969970703e-4F), r);
  r = multiply_add(n, splat(-7.549789954891882e-8F), r);
  const Floats z = r * r;
  Floats a = multiply_add(z, splat(1.0F / 362880), splat(-1.0F / 5040));
  a = multiply_add(a, z, splat(1.0F / 120));
  a = multiply_add(a, z, splat(-1.0F / 6));
  a = multiply_add(r * z, a, r);
  Floats b = multiply_add(z, splat(1.0F / 40320), splat(-1.0F / 720));
  b = multiply_add(b, z, splat(1.0F / 24));
  b = multiply_add(b, z, splat(-0.5F));
  b = multiply_add(b, z, splat(1.0F));
  Ints quarter;
  __builtin_memcpy(&quarter, &shifted, sizeof quarter);
  const Ints odd = (quarter & 1) != 0;
  const Floats s0 = odd ? b : a;
  const Floats c0 = odd ? a : b;
  Ints bits;
  __builtin_memcpy(&bits, &s0, sizeof bits);
  bits ^= (quarter & 2) << 30;
  __builtin_memcpy(&s, &bits, sizeof bits);
  __builtin_memcpy(&bits, &c0, sizeof bits);
  bits ^= ((quarter + 1) & 2) << 30;
  __builtin_memcpy(&c, &bits, sizeof bits);
}

}  // namespace MJARM_FLOAT_LANES
}  // namespace mjarm::detail
