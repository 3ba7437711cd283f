#pragma once

#include "mjarm/core/simd/functions.hpp"
#include "mjarm/kinematics/general_six_block_internal.hpp"

/// Newton's steps of GeneralSix, in lanes.
namespace mjarm::detail {
inline namespace MJARM_LANES {

using namespace simd;

inline constexpr double kTiny = 1e-300;  ///< keeps divisions by what may be 0 finite

inline Doubles magnitude(const Doubles& x) { return larger(x, -x); }

/// Of an angle.
struct CosSin {
  Doubles c, s;
};

inline void normalise(CosSin& q) {
  const Doubles f = 1.0 / square_root(q.c * q.c + q.s * q.s + kTiny);
  q.c = f * q.c;
  q.s = f * q.s;
}

/// A frame that is carried along the arm.
struct CarriedFrame {
  Doubles R[3][3];  ///< columns
  Doubles p[3];     ///< [m]

  explicit CarriedFrame(const Pose& X) {
    for (int i = 0; i < 3; ++i) {
      p[i] = splat(X.p[i]);
      for (int j = 0; j < 3; ++j) R[j][i] = splat(X.R(i, j));
    }
  }

  void carry(const Pose& X) {
    Doubles out[3][3];
    for (int i = 0; i < 3; ++i) {
      p[i] = p[i] + R[0][i] * X.p[0] + R[1][i] * X.p[1] + R[2][i] * X.p[2];
      for (int j = 0; j < 3; ++j) {
        out[j][i] = R[0][i] * X.R(0, j) + R[1][i] * X.R(1, j) + R[2][i] * X.R(2, j);
      }
    }
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) R[j][i] = out[j][i];
    }
  }

  void turn(const CosSin& q) {
    for (int i = 0; i < 3; ++i) {
      const Doubles x = R[0][i], y = R[1][i];
      R[0][i] = q.c * x + q.s * y;
      R[1][i] = q.c * y - q.s * x;
    }
  }
};

/// Takes configurations to a pose.
class GeneralPolish {
 public:
  GeneralPolish(const GeneralGeometry& geometry, const Pose& X_WT, CosSin (&q)[6])
      : chain_(geometry.chain), goal_(X_WT), weight_(1 / geometry.length), q_(q) {}

  /// Joint 1 that brings the tool's orientation nearest to that of the pose, given the others.
  void set_first() {
    CarriedFrame F(chain_.X_PJ[1]);
    F.turn(q_[1]);
    for (unsigned k = 2; k < 6; ++k) {
      F.carry(chain_.X_PJ[k]);
      F.turn(q_[k]);
    }
    F.carry(chain_.X_JT);
    // D = R_goal R_1T^T, seen from the unmoved frame of joint 1.
    Doubles D[2][2];
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        D[i][j] = splat(0.0);
        for (int l = 0; l < 3; ++l) {
          double goal = 0;
          for (int m = 0; m < 3; ++m) goal += chain_.X_PJ[0].R(m, i) * goal_.R(m, l);
          D[i][j] = D[i][j] + goal * F.R[l][j];
        }
      }
    }
    q_[0] = {D[0][0] + D[1][1], D[1][0] - D[0][1]};
    normalise(q_[0]);
  }

  /// Steps until every lane is exact; the error that is left.
  Doubles run() {
    constexpr int kSteps = 12;
    constexpr double kExactly = 1e-13;
    Doubles error = measure();
    for (int i = 0; i < kSteps && any_above(error, kExactly); ++i) {
      step(error);
      error = measure();
    }
    return error;
  }

 private:
  static bool any_above(const Doubles& x, double bound) {
    bool any = false;
    for (int k = 0; k < kDoubles; ++k) any = any || x[k] > bound;
    return any;
  }

  /// Forward kinematics and Jacobian, lengths in units of `length`; the size of the error.
  Doubles measure() {
    CarriedFrame F(chain_.X_PJ[0]);
    Doubles place[6][3];
    for (unsigned k = 0; k < 6; ++k) {
      if (k > 0) F.carry(chain_.X_PJ[k]);
      for (int i = 0; i < 3; ++i) {
        place[k][i] = F.p[i];
        J_[k][3 + i] = F.R[2][i];
      }
      F.turn(q_[k]);
    }
    F.carry(chain_.X_JT);
    for (int k = 0; k < 6; ++k) {
      Doubles d[3];
      for (int i = 0; i < 3; ++i) d[i] = weight_ * (F.p[i] - place[k][i]);
      const Doubles* const h = J_[k] + 3;
      J_[k][0] = h[1] * d[2] - h[2] * d[1];
      J_[k][1] = h[2] * d[0] - h[0] * d[2];
      J_[k][2] = h[0] * d[1] - h[1] * d[0];
    }
    return compare(F);
  }

  Doubles compare(const CarriedFrame& F) {
    Doubles size2 = splat(0.0), trace = splat(0.0);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      e_[i] = weight_ * (goal_.p[i] - F.p[i]);
      Doubles w = splat(0.0);
      for (int l = 0; l < 3; ++l) {
        w = w + F.R[l][j] * goal_.R(k, l) - F.R[l][k] * goal_.R(j, l);
        trace = trace + F.R[l][i] * goal_.R(i, l);
      }
      e_[3 + i] = 0.5 * w;
      size2 = size2 + e_[i] * e_[i] + e_[3 + i] * e_[3 + i];
    }
    // Opposite orientations have no sine between them.
    return square_root(size2 + larger(1.0 - trace, splat(0.0)));
  }

  /// (J^T J + damping) dq = J^T e by Cholesky; the damping dies out with the error.
  void step(const Doubles& error) {
    constexpr double kLongest = 0.3;  // [rad] of any joint
    Doubles A[6][6], x[6];
    const Doubles damping = 1e-14 + smaller(1e-3 * error * error, splat(1e-4));
    for (int i = 0; i < 6; ++i) {
      x[i] = splat(0.0);
      for (int k = 0; k < 6; ++k) x[i] = x[i] + J_[i][k] * e_[k];
      for (int j = 0; j <= i; ++j) {
        A[i][j] = i == j ? damping : splat(0.0);
        for (int k = 0; k < 6; ++k) A[i][j] = A[i][j] + J_[i][k] * J_[j][k];
      }
    }
    solve(A, x);
    Doubles most = splat(0.0);
    for (const Doubles& value : x) most = larger(most, magnitude(value));
    const Doubles share = select(most > kLongest, kLongest / most, splat(1.0));
    for (int i = 0; i < 6; ++i) {
      CosSin d;
      sine_cosine(share * x[i], d.s, d.c);
      q_[i] = {q_[i].c * d.c - q_[i].s * d.s, q_[i].s * d.c + q_[i].c * d.s};
    }
  }

  static void solve(Doubles (&A)[6][6], Doubles (&x)[6]) {
    for (int j = 0; j < 6; ++j) {
      for (int k = 0; k < j; ++k) A[j][j] = A[j][j] - A[j][k] * A[j][k];
      A[j][j] = 1.0 / square_root(larger(A[j][j], splat(1e-16)));
      for (int i = j + 1; i < 6; ++i) {
        for (int k = 0; k < j; ++k) A[i][j] = A[i][j] - A[i][k] * A[j][k];
        A[i][j] = A[i][j] * A[j][j];
      }
    }
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < i; ++k) x[i] = x[i] - A[i][k] * x[k];
      x[i] = x[i] * A[i][i];
    }
    for (int i = 5; i >= 0; --i) {
      for (int k = i + 1; k < 6; ++k) x[i] = x[i] - A[k][i] * x[k];
      x[i] = x[i] * A[i][i];
    }
  }

  const Chain& chain_;
  const Pose& goal_;
  double weight_;
  CosSin (&q_)[6];
  Doubles J_[6][6];  // by joints
  Doubles e_[6];
};

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
