#pragma once

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

/// A few floats at a time, as wide as the file that includes this header is compiled for. Each
/// width has its own namespace and nothing of the standard library is used, so that no function of
/// one width can stand in for that of another.
namespace mjarm::rl::detail {

#if defined(__AVX512F__)
#define MJARM_FLOAT_LANES floats_avx512
inline namespace MJARM_FLOAT_LANES {
inline constexpr int kWidth = 16;
#elif defined(__AVX2__)
#define MJARM_FLOAT_LANES floats_avx2
inline namespace MJARM_FLOAT_LANES {
inline constexpr int kWidth = 8;
#else
#define MJARM_FLOAT_LANES floats_baseline
inline namespace MJARM_FLOAT_LANES {
inline constexpr int kWidth = 4;
#endif

typedef float Floats __attribute__((vector_size(4 * kWidth)));
using FloatMask = decltype(Floats{} < Floats{});  ///< -1: true, 0: false

inline Floats load(const float* from) {
  Floats out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}

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

inline FloatMask bits_of(const Floats& x) {
  FloatMask out;
  __builtin_memcpy(&out, &x, sizeof out);
  return out;
}

inline Floats floats_of(const FloatMask& bits) {
  Floats out;
  __builtin_memcpy(&out, &bits, sizeof out);
  return out;
}

inline Floats square_root(const Floats& x) {
#if defined(__AVX512F__)
  return (Floats)_mm512_mask_sqrt_ps((__m512)x, 0xffff, (__m512)x);
#elif defined(__AVX2__)
  return (Floats)_mm256_sqrt_ps((__m256)x);
#elif defined(__SSE2__)
  return (Floats)_mm_sqrt_ps((__m128)x);
#else
  Floats out = x;
  for (int k = 0; k < kWidth; ++k) out[k] = __builtin_sqrtf(x[k]);
  return out;
#endif
}

/// Hyperbolic tangent, relative error below 5e-7 for every float; odd to the last bit, NaN stays.
/// tanh x = e / (e + 2) with e = exp(2 x) - 1, which is had without cancellation: the multiple of
/// ln 2 next to 2 x is taken off in two parts (W. J. Cody and W. Waite, 1980), the rest is a Taylor
/// series without its 1.
inline Floats hyperbolic_tangent(const Floats& x) {
  constexpr float kMagic = 12582912.0F;  // 1.5 * 2^23: adding it rounds to a whole number
  const FloatMask sign = bits_of(x) & static_cast<int>(0x80000000U);
  const Floats size = floats_of(bits_of(x) ^ sign);
  const Floats t = 2.0F * (size > 9.1F ? Floats{} + 9.1F : size);  // tanh(9.1) is 1 - 3e-8: 1
  const Floats shifted = t * 1.44269504F + kMagic;
  const Floats n = shifted - kMagic;
  Floats r = t - n * 0.693359375F;  // the first 10 bits of ln 2, the rest
  r = r + n * 2.12194440e-4F;
  Floats p = Floats{} + 1.0F / 5040;
  p = p * r + 1.0F / 720;
  p = p * r + 1.0F / 120;
  p = p * r + 1.0F / 24;
  p = p * r + 1.0F / 6;
  p = p * r + 0.5F;
  p = p * r * r + r;
  const Floats power = floats_of((bits_of(shifted) + 127) << 23);  // 2^n
  const Floats e = power * p + (power - 1.0F);
  return floats_of(bits_of(e / (e + 2.0F)) | sign);
}

}  // namespace MJARM_FLOAT_LANES
}  // namespace mjarm::rl::detail
