#pragma once

#include "mjarm/core/simd/functions.hpp"
#include "mjarm/core/simd/lanes.hpp"
#include "mjarm/trajectory/retime_lanes_internal.hpp"

/// Objective and local model of the time law, several knots at a time.
namespace mjarm::detail {
inline namespace MJARM_LANES {

using simd::Doubles;
using simd::load;
using simd::splat;
using simd::store;

/// One number of each of some knots.
inline Doubles at(const double* column, std::size_t i) { return load(column + i); }
inline void put(double* column, std::size_t i, const Doubles& x) { store(column + i, x); }

/// u and u' of all knots.
inline void place_knots(RetimeLanes& p, const double* c) {
  for (std::size_t i = 0; i < p.stride; i += simd::kDoubles) {
    const Doubles c0 = load(c + i), c1 = load(c + i + 1);
    put(p.u, i, at(p.first, i) * c0 + at(p.second, i) * c1);
    put(p.du, i, at(p.slope, i) * (c1 - c0));
  }
}

/// Where some knots are.
struct Station {
  Doubles u, du, root, bend_before, bend_after, middle;
};
inline Station station(const RetimeLanes& p, std::size_t i) {
  Station s;
  s.u = at(p.u, i);
  s.du = at(p.du, i);
  const Doubles next = at(p.du, i + 1);
  s.root = simd::square_root(s.u);
  s.bend_after = (next - s.du) * at(p.after, i);
  s.bend_before = (s.du - load(p.du + i - 1)) * at(p.before, i);
  s.middle = 0.5 * (s.u + at(p.u, i + 1)) + at(p.eighth, i) * (s.du - next);
  return s;
}

/// Multiplies what is left of bounds on jerks into `slack`, and keeps the least of them.
inline void take_jerks(const RetimeLanes& p, const Station& s, bool after, std::size_t i,
                       Doubles& slack, Doubles& least) {
  const double* const j_j = after ? p.j_after : p.j_before;
  const double* const a_j = after ? p.a_after : p.a_before;
  const double* const v_j = after ? p.v_after : p.v_before;
  const Doubles bend = after ? s.bend_after : s.bend_before;
  for (std::size_t r = 0, k = i; r < p.rows; ++r, k += p.stride) {
    const Doubles x = s.root * (at(j_j, k) * s.u + at(a_j, k) * s.du + at(v_j, k) * bend);
    const Doubles left = 1.0 - x * x;
    least = simd::smaller(least, left);
    slack = slack * left;
  }
}

inline Doubles acceleration(const RetimeLanes& p, const Station& s, std::size_t k) {
  const Doubles x = at(p.a_a, k) * s.u + at(p.v_a, k) * s.du;
  return p.rests ? x + at(p.root_a, k) * s.root + at(p.still, k) : x;
}

inline double value_in_lanes(RetimeLanes& p, const double* c, double mu) {
  place_knots(p, c);
  Doubles sum{}, least = splat(1.0);
  for (std::size_t i = 0; i < p.stride; i += simd::kDoubles) {
    const Station s = station(p, i);
    Doubles slack = 1.0 - s.u * at(p.by_u_max, i);
    least = simd::smaller(simd::smaller(least, slack), simd::smaller(s.u, s.middle));
    for (std::size_t r = 0, k = i; r < p.a_rows; ++r, k += p.stride) {
      const Doubles x = acceleration(p, s, k);
      const Doubles left = 1.0 - x * x;
      least = simd::smaller(least, left);
      slack = slack * left;
    }
    take_jerks(p, s, true, i, slack, least);
    take_jerks(p, s, false, i, slack, least);
    const Doubles weight = at(p.weight, i);
    sum += weight / (3.0 * s.root) + at(p.middle_time, i) / simd::square_root(s.middle) -
           mu * weight * simd::natural_logarithm(slack);
  }
  double total = 0, worst = 1;
  for (int k = 0; k < simd::kDoubles; ++k) {
    total += sum[k];
    if (!(least[k] > 0)) worst = 0;
  }
  return worst > 0 ? total : __builtin_inf();
}

/// Sums of first and second derivatives by u, u' and u'' at some knots.
struct Slopes {
  Doubles u{}, d{}, b{}, uu{}, ud{}, dd{}, ub{}, db{}, bb{};
};

/// Adds the barrier of x in [-1, 1], given its derivatives.
inline Doubles barrier(const Doubles& x, const Doubles& weight, Doubles& curvature) {
  const Doubles square = x * x, left = 1.0 / (1.0 - square);
  curvature = weight * 2.0 * (1.0 + square) * left * left;
  return weight * 2.0 * x * left;
}

inline Slopes jerk_slopes(const RetimeLanes& p, const Station& s, bool after, std::size_t i,
                          const Doubles& weight) {
  const double* const j_j = after ? p.j_after : p.j_before;
  const double* const a_j = after ? p.a_after : p.a_before;
  const double* const v_j = after ? p.v_after : p.v_before;
  const Doubles bend = after ? s.bend_after : s.bend_before, half = 0.5 / s.root;
  Slopes out;
  for (std::size_t r = 0, k = i; r < p.rows; ++r, k += p.stride) {
    const Doubles inner = at(j_j, k) * s.u + at(a_j, k) * s.du + at(v_j, k) * bend;
    const Doubles by_u = half * inner + s.root * at(j_j, k), by_d = s.root * at(a_j, k),
                  by_b = s.root * at(v_j, k);
    Doubles curvature;
    const Doubles slope = barrier(s.root * inner, weight, curvature);
    out.u += slope * by_u;
    out.d += slope * by_d;
    out.b += slope * by_b;
    const Doubles cu = curvature * by_u, cd = curvature * by_d;
    out.uu += cu * by_u;
    out.ud += cu * by_d;
    out.dd += cd * by_d;
    out.ub += cu * by_b;
    out.db += cd * by_b;
    out.bb += curvature * by_b * by_b;
  }
  return out;
}

/// Bounds of accelerations and of u, and the time.
inline void add_knot_slopes(const RetimeLanes& p, const Station& s, std::size_t i,
                            const Doubles& weight, Slopes& out) {
  for (std::size_t r = 0, k = i; r < p.a_rows; ++r, k += p.stride) {
    Doubles by_u = at(p.a_a, k);
    const Doubles by_d = at(p.v_a, k);
    if (p.rests) by_u += 0.5 * at(p.root_a, k) / s.root;
    Doubles curvature;
    const Doubles slope = barrier(acceleration(p, s, k), weight, curvature);
    out.u += slope * by_u;
    out.d += slope * by_d;
    out.uu += curvature * by_u * by_u;
    out.ud += curvature * by_u * by_d;
    out.dd += curvature * by_d * by_d;
  }
  const Doubles by = at(p.by_u_max, i), free = by / (1.0 - s.u * by);
  const Doubles time = at(p.weight, i) / (3.0 * s.root * s.u);
  out.u += weight * free - 0.5 * time;
  out.uu += weight * free * free + 0.75 * time / s.u;
}

/// What a sum of terms at some knots is by the coefficients about them.
inline void put_model(RetimeLanes& p, std::size_t i, const Station& s, const Slopes& knot,
                      const Slopes& before, const Slopes& after) {
  const Doubles f = at(p.first, i), n = at(p.second, i), d = at(p.slope, i);
  const Doubles d_before = load(p.slope + i - 1), d_after = at(p.slope, i + 1);
  const Doubles hb = at(p.before, i), ha = at(p.after, i);
  // u'' of the cell before by c[i-1] to c[i+1], of the cell after by c[i] to c[i+2].
  const Doubles b0 = d_before * hb, b2 = d * hb, b1 = -b0 - b2;
  const Doubles a0 = d * ha, a2 = d_after * ha, a1 = -a0 - a2;
  // u in the middle of the cell after.
  const Doubles e = at(p.eighth, i), f_after = at(p.first, i + 1), n_after = at(p.second, i + 1);
  const Doubles m0 = 0.5 * f - e * d, m1 = 0.5 * (n + f_after) + e * (d + d_after),
                m2 = 0.5 * n_after - e * d_after;
  const Doubles time = at(p.middle_time, i) / (simd::square_root(s.middle) * s.middle);
  const Doubles gm = -0.5 * time, hm = 0.75 * time / s.middle;

  const Doubles u = knot.u + before.u + after.u, du = knot.d + before.d + after.d;
  put(p.g[0], i, before.b * b0);
  put(p.g[1], i, u * f - du * d + before.b * b1 + after.b * a0 + gm * m0);
  put(p.g[2], i, u * n + du * d + before.b * b2 + after.b * a1 + gm * m1);
  put(p.g[3], i, after.b * a2 + gm * m2);

  const Doubles uu = knot.uu + before.uu + after.uu, ud = knot.ud + before.ud + after.ud,
                dd = (knot.dd + before.dd + after.dd) * d * d;
  const Doubles vb0 = before.ub * f - before.db * d, vb1 = before.ub * n + before.db * d;
  const Doubles va0 = after.ub * f - after.db * d, va1 = after.ub * n + after.db * d;
  const Doubles bb = before.bb, aa = after.bb;
  put(p.diagonal[0], i, bb * b0 * b0);
  put(p.diagonal[1], i,
      uu * f * f - 2.0 * ud * f * d + dd + (2.0 * vb0 + bb * b1) * b1 + (2.0 * va0 + aa * a0) * a0 +
          hm * m0 * m0);
  put(p.diagonal[2], i,
      uu * n * n + 2.0 * ud * n * d + dd + (2.0 * vb1 + bb * b2) * b2 + (2.0 * va1 + aa * a1) * a1 +
          hm * m1 * m1);
  put(p.diagonal[3], i, aa * a2 * a2 + hm * m2 * m2);
  put(p.next[0], i, (vb0 + bb * b1) * b0);
  put(p.next[1], i,
      uu * f * n + ud * (f - n) * d - dd + vb0 * b2 + vb1 * b1 + bb * b1 * b2 + va0 * a1 +
          va1 * a0 + aa * a0 * a1 + hm * m0 * m1);
  put(p.next[2], i, (va1 + aa * a1) * a2 + hm * m1 * m2);
  put(p.skip[0], i, (vb1 + bb * b2) * b0);
  put(p.skip[1], i, (va0 + aa * a0) * a2 + hm * m0 * m2);
}

inline void model_in_lanes(RetimeLanes& p, const double* c, double mu) {
  place_knots(p, c);
  for (std::size_t i = 0; i < p.stride; i += simd::kDoubles) {
    const Station s = station(p, i);
    const Doubles weight = mu * at(p.weight, i);
    const Slopes before = jerk_slopes(p, s, false, i, weight);
    const Slopes after = jerk_slopes(p, s, true, i, weight);
    Slopes knot;
    add_knot_slopes(p, s, i, weight, knot);
    put_model(p, i, s, knot, before, after);
  }
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
