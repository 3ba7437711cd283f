#pragma once

#include <numbers>

#include "mjarm/core/simd/lanes.hpp"

/// Sine, cosine, hyperbolic tangent and logarithm of all lanes at once.
namespace mjarm::simd {

/// Largest error of sine_cosine() of floats, for |x| <= kMaxAngle: the reduced angle is right to
/// 3e-8 (three parts of pi/2, the first of 8 and the second of 11 bits, so that their products with
/// the number of quarters are exact), Taylor's tails are below 3e-8, and what is left are
/// roundings.
inline constexpr double kTrigError = 3e-7;
inline constexpr double kMaxAngle = 100;  ///< [rad]

inline namespace MJARM_LANES {

/// Sine and cosine from those of the reduced angle. The lowest bits of `shifted` count the quarter
/// turns that were taken off: they say which is which, and the signs.
template <class Bits, class V>
inline __attribute__((always_inline)) void put_quarters_back(const V& shifted, const V& sine,
                                                             const V& cosine, V& s, V& c) {
  constexpr int kToSign = 8 * sizeof(shifted[0]) - 2;
  const Bits quarter = bits_as<Bits>(shifted);
  const Bits odd = -(quarter & 1);
  const V s0 = odd ? cosine : sine;
  const V c0 = odd ? sine : cosine;
  s = bits_as<V>(bits_as<Bits>(s0) ^ ((quarter & 2) << kToSign));
  c = bits_as<V>(bits_as<Bits>(c0) ^ (((quarter + 1) & 2) << kToSign));
}

/// For |x| < 1e5, to 1e-15: the argument is reduced to a quarter turn by three parts of pi/2
/// (W. J. Cody and W. Waite, 1980), then Taylor's series.
inline void sine_cosine(const Doubles& x, Doubles& s, Doubles& c) {
  constexpr double kMagic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to a whole number
  const Doubles shifted = x * (2 / std::numbers::pi) + kMagic;
  const Doubles n = shifted - kMagic;
  Doubles r = x - n * 1.5707963267341256;  // the first 33 bits of pi/2, the next 33, the rest
  r = r - n * 6.0771005063039660e-11;
  r = r - n * 2.0222662487959506e-21;
  const Doubles z = r * r;
  Doubles a = splat(-1.0 / 1307674368000);
  a = a * z + 1.0 / 6227020800;
  a = a * z - 1.0 / 39916800;
  a = a * z + 1.0 / 362880;
  a = a * z - 1.0 / 5040;
  a = a * z + 1.0 / 120;
  a = a * z - 1.0 / 6;
  a = r + r * z * a;
  Doubles b = splat(1.0 / 20922789888000);
  b = b * z - 1.0 / 87178291200;
  b = b * z + 1.0 / 479001600;
  b = b * z - 1.0 / 3628800;
  b = b * z + 1.0 / 40320;
  b = b * z - 1.0 / 720;
  b = b * z + 1.0 / 24;
  b = 1.0 - 0.5 * z + z * z * b;
  put_quarters_back<Longs>(shifted, a, b, s, c);
}

/// The same for |x| <= kMaxAngle, to kTrigError.
inline void sine_cosine(Floats x, Floats& s, Floats& c) {
  constexpr float kMagic = 12582912.0F;  // 1.5 * 2^23
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
  put_quarters_back<Ints>(shifted, a, b, s, c);
}

/// Natural logarithm of positive normal numbers, to 3e-16 or two units in the last place. The
/// number is split into 2^n m, m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh((m - 1) / (m + 1)), whose
/// series ends at 1e-18. Of other numbers it is some value that means nothing.
inline Doubles natural_logarithm(const Doubles& x) {
  constexpr std::uint64_t kRoot = 0x3fe6a09e667f3bcd;  // bits of sqrt(1/2)
  constexpr double kMagic = 6755399441055744.0;        // 1.5 * 2^52
  const UnsignedLongs bits = bits_as<UnsignedLongs>(x);
  const Longs n = bits_as<Longs>(bits - kRoot) >> 52;
  const Doubles m = bits_as<Doubles>(bits - (bits_as<UnsignedLongs>(n) << 52));
  const Doubles count = bits_as<Doubles>(n + bits_as<Longs>(splat(kMagic))) - kMagic;
  const Doubles s = (m - 1.0) / (m + 1.0), z = s * s;
  Doubles p = splat(1.0 / 21);
  p = p * z + 1.0 / 19;
  p = p * z + 1.0 / 17;
  p = p * z + 1.0 / 15;
  p = p * z + 1.0 / 13;
  p = p * z + 1.0 / 11;
  p = p * z + 1.0 / 9;
  p = p * z + 1.0 / 7;
  p = p * z + 1.0 / 5;
  p = p * z + 1.0 / 3;
  const Doubles rest = count * 1.90821492927058770002e-10 + 2.0 * s * z * p;
  return count * 6.93147180369123816490e-01 + (2.0 * s + rest);  // ln 2 in two parts
}

/// Hyperbolic tangent, relative error below 5e-7 for every float; odd to the last bit, NaN stays.
/// tanh x = e / (e + 2) with e = exp(2 x) - 1, which is had without cancellation: the multiple of
/// ln 2 next to 2 x is taken off in two parts (W. J. Cody and W. Waite, 1980), the rest is a Taylor
/// series without its 1.
inline Floats hyperbolic_tangent(const Floats& x) {
  constexpr float kMagic = 12582912.0F;  // 1.5 * 2^23: adding it rounds to a whole number
  const Ints sign = bits_as<Ints>(x) & static_cast<int>(0x80000000U);
  const Floats size = bits_as<Floats>(bits_as<Ints>(x) ^ sign);
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
  const Floats power = bits_as<Floats>((bits_as<Ints>(shifted) + 127) << 23);  // 2^n
  const Floats e = power * p + (power - 1.0F);
  return bits_as<Floats>(bits_as<Ints>(e / (e + 2.0F)) | sign);
}

}  // namespace MJARM_LANES
}  // namespace mjarm::simd
