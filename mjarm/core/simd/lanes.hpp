#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

/// A few numbers at a time, as many as a register holds for which the file that includes this
/// header is compiled. For the kernels of the rooms (`*_avx2.cpp`, `*_avx512.cpp` and what they
/// share); it is not installed.
///
/// Each width has its own namespace, MJARM_LANES, in which kernels stand too, and nothing here
/// calls a function of the standard library: no function of one width may stand in for that of
/// another.
namespace mjarm::simd {

#if defined(__AVX512F__)
#define MJARM_LANES avx512
inline namespace MJARM_LANES {
inline constexpr int kBytes = 64;
#elif defined(__AVX2__)
#define MJARM_LANES avx2
inline namespace MJARM_LANES {
inline constexpr int kBytes = 32;
#else
#define MJARM_LANES baseline
inline namespace MJARM_LANES {
inline constexpr int kBytes = 16;
#endif

inline constexpr int kDoubles = kBytes / 8;  ///< lanes of a register
inline constexpr int kFloats = kBytes / 4;

typedef double Doubles __attribute__((vector_size(kBytes)));
typedef float Floats __attribute__((vector_size(kBytes)));
typedef std::int64_t Longs __attribute__((vector_size(kBytes)));
typedef std::uint64_t UnsignedLongs __attribute__((vector_size(kBytes)));
typedef std::int32_t Ints __attribute__((vector_size(kBytes)));
using DoubleMask = decltype(Doubles{} < Doubles{});  ///< -1: true, 0: false
using FloatMask = decltype(Floats{} < Floats{});     ///< -1: true, 0: false
typedef float Quad __attribute__((vector_size(16)));

/// One bit a lane of floats, lane 0 lowest.
using LaneBits = std::uint32_t;
inline constexpr LaneBits kAllLanes = (LaneBits{1} << kFloats) - 1;

/// The same bits as another type of the same size.
template <class To, class From>
inline To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To out;
  __builtin_memcpy(&out, &from, sizeof out);
  return out;
}

inline Doubles load(const double* from) {
  Doubles out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
inline Floats load(const float* from) {
  Floats out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
inline void store(double* to, const Doubles& x) { __builtin_memcpy(to, &x, sizeof x); }
inline void store(float* to, const Floats& x) { __builtin_memcpy(to, &x, sizeof x); }

/// The first `count` lanes, 0 in the others.
inline Floats load_some(const float* from, int count) {
  Floats out{};
  __builtin_memcpy(&out, from, 4 * static_cast<unsigned long>(count));
  return out;
}
inline void store_some(float* to, const Floats& x, int count) {
  __builtin_memcpy(to, &x, 4 * static_cast<unsigned long>(count));
}

inline Doubles splat(double x) { return Doubles{} + x; }
inline Doubles select(const DoubleMask& where, const Doubles& yes, const Doubles& no) {
  return where ? yes : no;
}
inline Doubles smaller(const Doubles& a, const Doubles& b) { return a < b ? a : b; }
inline Doubles larger(const Doubles& a, const Doubles& b) { return a > b ? a : b; }

// Splats of floats by intrinsics read memory as they spread it; a sum with zero would be worked
// out. The masked forms, as the plain ones trip a warning of GCC 12 about their undefined source.
#if defined(__AVX512F__)
inline Doubles square_root(const Doubles& x) {
  return (Doubles)_mm512_maskz_sqrt_pd(0xff, (__m512d)x);
}
inline Floats splat(float x) { return (Floats)_mm512_set1_ps(x); }
inline Floats multiply_add(Floats a, Floats b, Floats c) {
  return (Floats)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
}
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
#elif defined(__AVX2__)
inline Doubles square_root(const Doubles& x) { return (Doubles)_mm256_sqrt_pd((__m256d)x); }
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
inline Doubles square_root(const Doubles& x) { return (Doubles)_mm_sqrt_pd((__m128d)x); }
inline Floats splat(float x) { return (Floats)_mm_set1_ps(x); }
inline Floats multiply_add(Floats a, Floats b, Floats c) { return a * b + c; }
inline Floats smaller(Floats a, Floats b) { return (Floats)_mm_min_ps((__m128)a, (__m128)b); }
inline Floats larger(Floats a, Floats b) { return (Floats)_mm_max_ps((__m128)a, (__m128)b); }
inline Floats square_root(Floats x) { return (Floats)_mm_sqrt_ps((__m128)x); }
inline LaneBits less(Floats a, Floats b) {
  return static_cast<LaneBits>(_mm_movemask_ps(_mm_cmplt_ps((__m128)a, (__m128)b)));
}
#else
inline Doubles square_root(const Doubles& x) {
  Doubles out = x;
  for (int k = 0; k < kDoubles; ++k) out[k] = __builtin_sqrt(x[k]);
  return out;
}
inline Floats splat(float x) { return Floats{} + x; }
inline Floats multiply_add(Floats a, Floats b, Floats c) { return a * b + c; }
inline Floats smaller(Floats a, Floats b) { return a < b ? a : b; }
inline Floats larger(Floats a, Floats b) { return a > b ? a : b; }
inline Floats square_root(Floats x) {
  Floats out = x;
  for (int k = 0; k < kFloats; ++k) out[k] = __builtin_sqrtf(x[k]);
  return out;
}
inline LaneBits less(Floats a, Floats b) {
  const FloatMask where = a < b;
  LaneBits out = 0;
  for (int k = 0; k < kFloats; ++k) out |= (where[k] != 0 ? LaneBits{1} : 0) << k;
  return out;
}
#endif

#if defined(__AVX512F__)
inline Floats zero_where(LaneBits lanes, Floats x) {
  return (Floats)_mm512_maskz_mov_ps(static_cast<__mmask16>(~lanes), (__m512)x);
}
#else
inline Floats zero_where(LaneBits lanes, Floats x) {
  Ints bit;
  for (int k = 0; k < kFloats; ++k) bit[k] = 1 << k;
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
  for (int k = 0; k < kFloats; ++k) out[k] = from[index[k]];
  return out;
}
#endif

/// kFloats / 4 of them side by side.
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

}  // namespace MJARM_LANES
}  // namespace mjarm::simd
