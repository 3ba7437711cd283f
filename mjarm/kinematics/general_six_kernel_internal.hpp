#pragma once

#include "mjarm/kinematics/general_six_polish_internal.hpp"

/// The arithmetic of GeneralSix, kDoubles values of joint 4 at a time. Included by one file for
/// each width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

/// Turns the first `steps` columns of a matrix into an upper triangle by Householder's reflections.
template <int kHeight, int kWidth>
inline void triangulate(Doubles (&a)[kWidth][kHeight], int rows, int columns, int steps) {
  constexpr int kTogether = kWidth < 4 ? 1 : 4;  // columns that share what is loaded
  for (int j = 0; j < steps; ++j) {
    Doubles* const v = a[j];
    Doubles rest = splat(0.0);
    for (int i = j + 1; i < rows; ++i) rest = rest + v[i] * v[i];
    const Doubles top = v[j];
    const Doubles norm = square_root(rest + top * top);
    const Doubles diagonal = select(top > 0.0, -norm, norm);
    const Doubles factor = 1.0 / (norm * (norm + magnitude(top)) + kTiny);
    v[j] = top - diagonal;
    int k = j + 1;
    for (; k + kTogether <= columns; k += kTogether) {
      Doubles d[kTogether] = {};
      for (int i = j; i < rows; ++i) {
        for (int m = 0; m < kTogether; ++m) d[m] = d[m] + v[i] * a[k + m][i];
      }
      for (int m = 0; m < kTogether; ++m) d[m] = d[m] * factor;
      for (int i = j; i < rows; ++i) {
        for (int m = 0; m < kTogether; ++m) a[k + m][i] = a[k + m][i] - d[m] * v[i];
      }
    }
    for (; k < columns; ++k) {
      Doubles d = splat(0.0);
      for (int i = j; i < rows; ++i) d = d + v[i] * a[k][i];
      d = d * factor;
      for (int i = j; i < rows; ++i) a[k][i] = a[k][i] - d * v[i];
    }
    v[j] = diagonal;
  }
}

/// e0 + e1 cos x + e2 sin x times cos(x/2), and times sin(x/2): factors of cos(x/2), sin(x/2),
/// cos(3x/2), sin(3x/2). Unlike polynomials of tan(x/2) these know no infinity.
struct HalfAngles {
  Doubles by_cosine[4], by_sine[4];

  HalfAngles(const Doubles& e0, const Doubles& e1, const Doubles& e2) {
    const Doubles c = 0.5 * e1;
    const Doubles s = 0.5 * e2;
    by_cosine[0] = e0 + c;
    by_cosine[1] = s;
    by_cosine[2] = c;
    by_cosine[3] = s;
    by_sine[0] = s;
    by_sine[1] = e0 - c;
    by_sine[2] = -s;
    by_sine[3] = c;
  }
};

/// The equations at values of joint 4.
class GeneralLanes {
 public:
  GeneralLanes(const GeneralEquations& equations, const Doubles& q4) : equations_(equations) {
    sine_cosine(q4, q4_.s, q4_.c);
  }

  [[nodiscard]] const CosSin& q4() const { return q4_; }

  /// The six equations times cos and sin of q5/2, in joints 5 and 6: columns of the 12 x 12 matrix.
  void fill(const int* column, Doubles (*a)[12]) const {
    for (int r = 0; r < 6; ++r) {
      for (int k6 = 0; k6 < 3; ++k6) {
        const HalfAngles half = by_joint5(r, k6);
        for (int m = 0; m < 4; ++m) {
          Doubles* const to = a[column[3 * m + k6]] + 2 * r;
          to[0] = half.by_cosine[m];
          to[1] = half.by_sine[m];
        }
      }
    }
  }

  /// The joints 5 and 6 for which the equations come nearest to hold. They are multiplied by the
  /// products of cos and sin of q5/2 and q6/2: 24 of them, whose null vector is unique at an
  /// answer even where that of the matrix of fill() is not, and has those products in front.
  void wrist(bool pairs, CosSin& q5, CosSin& q6) const {
    Doubles a[16][24];
    for (int r = 0; r < 6; ++r) {
      const HalfAngles h0 = by_joint5(r, 0), h1 = by_joint5(r, 1), h2 = by_joint5(r, 2);
      for (int m = 0; m < 4; ++m) {
        const HalfAngles c(h0.by_cosine[m], h1.by_cosine[m], h2.by_cosine[m]);
        const HalfAngles s(h0.by_sine[m], h1.by_sine[m], h2.by_sine[m]);
        for (int l = 0; l < 4; ++l) {
          Doubles* const to = a[4 * m + l] + 4 * r;
          to[0] = c.by_cosine[l];
          to[1] = c.by_sine[l];
          to[2] = s.by_cosine[l];
          to[3] = s.by_sine[l];
        }
      }
    }
    triangulate(a, 24, 16, 16);
    Doubles inverse[16], x[16];
    for (int i = 0; i < 16; ++i) {
      inverse[i] = 1.0 / select(magnitude(a[i][i]) < kSmallPivot, splat(kSmallPivot), a[i][i]);
      x[i] = splat(1.0 / (3 + i));
    }
    for (int round = 0; round < kRounds; ++round) improve(a, inverse, x);
    if (pairs) split(a, inverse, x);
    const Doubles cc = x[0], cs = x[1], sc = x[4], ss = x[5];
    q5 = {cc * cc + cs * cs - sc * sc - ss * ss, 2.0 * (cc * sc + cs * ss)};
    q6 = {cc * cc + sc * sc - cs * cs - ss * ss, 2.0 * (cc * cs + sc * ss)};
    normalise(q5);
    normalise(q6);
  }

  /// The joints 2 and 3 that go with the others.
  void elbow(const CosSin& q5, const CosSin& q6, CosSin& q2, CosSin& q3) const {
    Doubles x[4];
    for (int i = 0; i < 4; ++i) {
      Doubles by6[3];
      for (int k6 = 0; k6 < 3; ++k6) {
        by6[k6] = at(6 + i, 0, k6) + q5.c * at(6 + i, 1, k6) + q5.s * at(6 + i, 2, k6);
      }
      x[i] = by6[0] + q6.c * by6[1] + q6.s * by6[2];
    }
    q2 = {x[0], x[1]};
    q3 = {x[2], x[3]};
    normalise(q2);
    normalise(q3);
  }

 private:
  static constexpr int kRounds = 2;
  static constexpr double kSmallPivot = 1e-18;

  /// Equation `r` at the factors `k5` and `k6`.
  [[nodiscard]] Doubles at(int r, int k5, int k6) const {
    const double* e = equations_.at[k6] + 9 * r + k5;
    return e[0] + q4_.c * e[3] + q4_.s * e[6];
  }
  [[nodiscard]] HalfAngles by_joint5(int r, int k6) const {
    return {at(r, 0, k6), at(r, 1, k6), at(r, 2, k6)};
  }

  /// One step of inverse iteration towards the smallest singular value of the triangle.
  static void improve(const Doubles (&a)[16][24], const Doubles (&inverse)[16], Doubles (&x)[16]) {
    for (int i = 0; i < 16; ++i) {
      for (int k = 0; k < i; ++k) x[i] = x[i] - a[i][k] * x[k];
      x[i] = x[i] * inverse[i];
    }
    for (int i = 15; i >= 0; --i) {
      for (int k = i + 1; k < 16; ++k) x[i] = x[i] - a[k][i] * x[k];
      x[i] = x[i] * inverse[i];
    }
    Doubles size2 = splat(kTiny);
    for (const Doubles& value : x) size2 = size2 + value * value;
    const Doubles factor = 1.0 / square_root(size2);
    for (Doubles& value : x) value = factor * value;
  }

  /// Two answers at nearly the same q4 are combinations of the vectors of the two smallest singular
  /// values: the one goes to even lanes, the other to odd ones. In the vector of an answer the four
  /// products of half angles in front make a matrix of rank 1.
  static void split(const Doubles (&a)[16][24], const Doubles (&inverse)[16], Doubles (&x)[16]) {
    Doubles y[16];
    for (int i = 0; i < 16; ++i) y[i] = splat(i % 2 == 0 ? 1.0 : -1.0);
    for (int round = 0; round < kRounds; ++round) {
      Doubles along = splat(0.0);
      for (int i = 0; i < 16; ++i) along = along + x[i] * y[i];
      for (int i = 0; i < 16; ++i) y[i] = y[i] - along * x[i];
      improve(a, inverse, y);
    }
    // A u^2 + B u v + C v^2 = 0 for u x + v y.
    const Doubles A = x[0] * x[5] - x[1] * x[4];
    const Doubles B = x[0] * y[5] + y[0] * x[5] - x[1] * y[4] - y[1] * x[4];
    const Doubles C = y[0] * y[5] - y[1] * y[4];
    const Doubles root = square_root(larger(B * B - 4.0 * A * C, splat(0.0)));
    const Doubles sum = B + select(B < 0.0, -root, root);
    Doubles odd;
    for (int k = 0; k < kDoubles; ++k) odd[k] = k % 2;
    const Doubles u = select(odd > 0.5, sum, -2.0 * C);
    const Doubles v = select(odd > 0.5, -2.0 * A, sum);
    for (int i = 0; i < 16; ++i) x[i] = u * x[i] + v * y[i];
  }

  const GeneralEquations& equations_;
  CosSin q4_;
};

inline void general_equations(const GeneralRows& rows, const double* flag, GeneralEquations& out) {
  // The parts of a flag that turn with joint 6 stand in pairs; the others are left as they are.
  constexpr int kPairs[4] = {0, 3, 6, 10};
  constexpr int kFixed[7] = {2, 5, 8, 9, 12, 13, 14};
  for (int at = 0; at < GeneralRows::kSize; at += kDoubles) {
    Doubles fixed = splat(0.0), c = fixed, s = fixed;
    for (const int i : kFixed) fixed = fixed + load(rows.part[i] + at) * flag[i];
    for (const int i : kPairs) {
      const Doubles x = load(rows.part[i] + at), y = load(rows.part[i + 1] + at);
      c = c + x * flag[i] + y * flag[i + 1];
      s = s - x * flag[i + 1] + y * flag[i];
    }
    store(out.at[0] + at, fixed);
    store(out.at[1] + at, c);
    store(out.at[2] + at, s);
  }
}

inline Doubles general_determinant(const int* column, const GeneralLanes& lanes) {
  Doubles a[12][12];
  lanes.fill(column, a);
  triangulate(a, 12, 12, 11);
  Doubles product = a[0][0];
  for (int i = 1; i < 12; ++i) product = product * a[i][i];
  return product;
}

/// Of a matrix M that lacks rank at every pose, where M + e M' does not: the factor of the lowest
/// power of e in its determinant. With M = Q R, that is the product of the diagonal of R and the
/// determinant of the last rows of Q^T M' times the null space of R.
inline Doubles lowest_determinant(const int* column, int lacking, const GeneralLanes& lanes,
                                  const GeneralLanes& change) {
  Doubles a[24][12];
  lanes.fill(column, a);
  change.fill(column, a + 12);
  const int n = 12 - lacking;
  triangulate(a, 12, 24, n);
  Doubles product = splat(1.0);
  Doubles inverse[12];
  for (int i = 0; i < n; ++i) {
    product = product * a[i][i];
    inverse[i] = 1.0 / (a[i][i] + kTiny);
  }
  Doubles rest[GeneralGeometry::kMostLacking][GeneralGeometry::kMostLacking];
  for (int j = 0; j < lacking; ++j) {
    Doubles* const x = a[n + j];
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) x[i] = x[i] - a[k][i] * x[k];
      x[i] = x[i] * inverse[i];
    }
    for (int r = 0; r < lacking; ++r) {
      rest[j][r] = a[12 + n + j][n + r];
      for (int k = 0; k < n; ++k) rest[j][r] = rest[j][r] - a[12 + k][n + r] * x[k];
    }
  }
  triangulate(rest, lacking, lacking, lacking - 1);
  for (int i = 0; i < lacking; ++i) product = product * rest[i][i];
  return product;
}

inline void general_determinants(const GeneralGeometry& g, const GeneralEquations& equations,
                                 const GeneralEquations& change, int order, const double* q4,
                                 double* out) {
  const int* const column = g.column[order];
  for (int at = 0; at < kBlock; at += kDoubles) {
    const Doubles q = load(q4 + at);
    const GeneralLanes lanes(equations, q);
    store(out + at, g.lacking == 0
                        ? general_determinant(column, lanes)
                        : lowest_determinant(column, g.lacking, lanes, GeneralLanes(change, q)));
  }
}

inline void general_configurations(const GeneralGeometry& geometry,
                                   const GeneralEquations& equations, const Pose& X_WT,
                                   const double* q4, bool pairs, GeneralBlock& out) {
  for (int at = 0; at < kBlock; at += kDoubles) {
    const GeneralLanes lanes(equations, load(q4 + at));
    CosSin q[6];
    q[3] = lanes.q4();
    lanes.wrist(pairs, q[4], q[5]);
    lanes.elbow(q[4], q[5], q[1], q[2]);
    GeneralPolish polish(geometry, X_WT, q);
    polish.set_first();
    store(out.error + at, polish.run());
    for (int i = 0; i < 6; ++i) {
      store(out.cosine[i] + at, q[i].c);
      store(out.sine[i] + at, q[i].s);
    }
  }
}

inline constexpr GeneralKernel kGeneralKernel{general_equations, general_determinants,
                                              general_configurations};

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
