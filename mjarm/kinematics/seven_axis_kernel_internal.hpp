#pragma once

#include <cmath>

#include "mjarm/core/simd/functions.hpp"
#include "mjarm/kinematics/seven_axis_block_internal.hpp"

/// The arithmetic of the closed form of seven axes, kDoubles values of the last joint at a time.
/// Included by one file for each width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

using namespace simd;

struct Vec3 {
  Doubles x, y, z;
};

/// Cosine and sine.
struct Angle {
  Doubles c, s;
  Angle operator+(const Angle& b) const { return {c * b.c - s * b.s, s * b.c + c * b.s}; }
};

inline Vec3 rotate(const double* R, const Vec3& v) {
  return {R[0] * v.x + R[3] * v.y + R[6] * v.z, R[1] * v.x + R[4] * v.y + R[7] * v.z,
          R[2] * v.x + R[5] * v.y + R[8] * v.z};
}
inline Vec3 rotate_back(const double* R, const Vec3& v) {
  return {R[0] * v.x + R[1] * v.y + R[2] * v.z, R[3] * v.x + R[4] * v.y + R[5] * v.z,
          R[6] * v.x + R[7] * v.y + R[8] * v.z};
}
inline Vec3 turn(const Angle& a, const Vec3& v) {
  return {a.c * v.x - a.s * v.y, a.s * v.x + a.c * v.y, v.z};
}
inline Vec3 turn_back(const Angle& a, const Vec3& v) {
  return {a.c * v.x + a.s * v.y, a.c * v.y - a.s * v.x, v.z};
}

/// The angle about z that carries `from` to `to`, whose distances to the axis are equal;
/// `otherwise` where they vanish.
inline Angle angle_between(const Vec3& from, const Vec3& to, const Doubles& c0, const Doubles& s0) {
  constexpr double kOnAxis = 1e-22;
  const Doubles size2 = to.x * to.x + to.y * to.y;
  const DoubleMask fine = size2 > kOnAxis;
  const Doubles f = 1.0 / select(fine, size2, splat(1.0));
  return {select(fine, f * (from.x * to.x + from.y * to.y), c0),
          select(fine, f * (from.x * to.y - from.y * to.x), s0)};
}

/// Sine to the cosine `c`, which is clamped to [-1, 1]; raises `open` where it was beyond.
inline Doubles sine_of(Doubles& c, Doubles& open) {
  open = larger(open, larger(c, -c) - 1.0);
  c = smaller(larger(c, splat(-1.0)), splat(1.0));
  return square_root(1.0 - c * c);
}

/// True where joint 4 is beyond its limits in every lane.
inline bool none_within(const Doubles& beyond) {
  bool none = true;
  for (int k = 0; k < kDoubles; ++k) none = none && beyond[k] > kSevenWithin;
  return none;
}

/// One call for kDoubles values of the last joint: what each stage leaves for the next.
class SevenLanes {
 public:
  SevenLanes(const SevenGeometry& geometry, const SevenGoal& goal, int offset, SevenBlock& out)
      : g_(geometry), goal_(goal), at_(offset), out_(out) {}

  void run(const Doubles& q7) {
    sine_cosine(q7, q7_.s, q7_.c);
    const Vec3 p_6S{splat(goal_.p_6S[0]), splat(goal_.p_6S[1]), splat(goal_.p_6S[2])};
    const Vec3 p_6uS = turn(q7_, p_6S);
    const Vec3 d_6u{p_6uS.x - g_.p_6uW[0], p_6uS.y - g_.p_6uW[1], p_6uS.z - g_.p_6uW[2]};
    d_5_ = rotate(g_.R_56, d_6u);
    Doubles beyond7 = splat(-4.0);
    Doubles away7 = splat(0.0);
    judge(6, q7_, beyond7, away7);
    const double* u = g_.p_3uS;
    const double* w = g_.p_3W;
    const double across = u[0] * w[0] + u[1] * w[1];
    const double turned = u[0] * w[1] - u[1] * w[0];
    const double size = std::sqrt(across * across + turned * turned);
    const double sum =
        u[0] * u[0] + u[1] * u[1] + w[0] * w[0] + w[1] * w[1] + (u[2] - w[2]) * (u[2] - w[2]);
    const Doubles d2 = d_5_.x * d_5_.x + d_5_.y * d_5_.y + d_5_.z * d_5_.z;
    // |Rz(-q4) u - w|^2 = sum - 2 size cos(q4 - q4 of the folded elbow).
    Doubles c = (0.5 / size) * (sum - d2);
    Doubles open = splat(-1.0);
    const Doubles s = sine_of(c, open);
    const Angle middle{splat(across / size), splat(-turned / size)};
    set_wrist_base();
    for (int e = 0; e < 2; ++e) {
      elbow(e, middle + Angle{c, e == 0 ? s : -s}, open, beyond7, away7);
    }
  }

 private:
  /// What the equation of joint 6 needs of d_5: its direction round axis 6.
  void set_wrist_base() {
    const double r0 = g_.R_45[2], r1 = g_.R_45[5];
    const Doubles a = r0 * d_5_.x + r1 * d_5_.y;
    const Doubles b = r1 * d_5_.x - r0 * d_5_.y;
    const Doubles size = square_root(a * a + b * b) + 1e-300;
    inverse6_ = 1.0 / size;
    base6_ = {a * inverse6_, b * inverse6_};
  }

  void elbow(int e, const Angle& q4, Doubles open, Doubles beyond, Doubles away) {
    judge(3, q4, beyond, away);
    if (!goal_.beyond_limits && none_within(beyond)) {
      for (int branch = 4 * e; branch < 4 * e + 4; ++branch) {
        store(out_.beyond[branch] + at_, beyond);
        store(out_.open[branch] + at_, splat(1.0));
      }
      return;
    }
    store(out_.elbow[e][0] + at_, q4.c);
    store(out_.elbow[e][1] + at_, q4.s);
    const Vec3 u{splat(g_.p_3uS[0]), splat(g_.p_3uS[1]), splat(g_.p_3uS[2])};
    const Vec3 p_3S = turn_back(q4, u);
    const Vec3 d_4u =
        rotate_back(g_.R_34, {p_3S.x - g_.p_3W[0], p_3S.y - g_.p_3W[1], p_3S.z - g_.p_3W[2]});
    // d_4u and R_45 Rz(q6) d_5 have the same z.
    Doubles c = (d_4u.z - g_.R_45[8] * d_5_.z) * inverse6_;
    const Doubles s = sine_of(c, open);
    for (int w = 0; w < 2; ++w) {
      wrist(e, w, q4, base6_ + Angle{c, w == 0 ? s : -s}, d_4u, open, beyond, away);
    }
  }

  void wrist(int e, int w, const Angle& q4, const Angle& q6, const Vec3& d_4u, const Doubles& open,
             Doubles beyond, Doubles away) {
    const Vec3 d_4 = rotate(g_.R_45, turn(q6, d_5_));
    const Angle q5 = angle_between(d_4, d_4u, splat(goal_.near_cos[4]), splat(goal_.near_sin[4]));
    judge(5, q6, beyond, away);
    judge(4, q5, beyond, away);
    double (*const to)[kBlock] = out_.wrist[2 * e + w];
    store(to[0] + at_, q5.c);
    store(to[1] + at_, q5.s);
    store(to[2] + at_, q6.c);
    store(to[3] + at_, q6.s);
    // Columns 0 and 2 of R_0u2: what is left for joints 1 to 3.
    Vec3 column[2];
    for (int k = 0; k < 2; ++k) {
      const int row = 2 * k;
      Vec3 v{splat(g_.R_23[row]), splat(g_.R_23[row + 3]), splat(g_.R_23[row + 6])};
      v = rotate_back(g_.R_34, turn_back(q4, v));
      v = rotate_back(g_.R_45, turn_back(q5, v));
      v = rotate_back(g_.R_56, turn_back(q6, v));
      column[k] = rotate(goal_.R_0u6, turn_back(q7_, v));
    }
    shoulder(4 * e + 2 * w, column, open, beyond, away);
  }

  void shoulder(int branch, const Vec3 (&column)[2], Doubles open, const Doubles& beyond,
                const Doubles& away) {
    const double* k = g_.R_12 + 6;
    const double r0 = g_.R_01[2], r1 = g_.R_01[5], r2 = g_.R_01[8];
    const double a = r0 * k[0] + r1 * k[1];
    const double b = r1 * k[0] - r0 * k[1];
    const double inverse = 1 / std::sqrt(a * a + b * b);
    Doubles c = (column[1].z - r2 * k[2]) * inverse;
    const Doubles s = sine_of(c, open);
    const Angle middle{splat(a * inverse), splat(b * inverse)};
    for (int side = 0; side < 2; ++side) {
      const Angle q2 = middle + Angle{c, side == 0 ? s : -s};
      const Vec3 v = rotate(g_.R_01, turn(q2, {splat(k[0]), splat(k[1]), splat(k[2])}));
      const Angle q1 =
          angle_between(v, column[1], splat(goal_.near_cos[0]), splat(goal_.near_sin[0]));
      const Vec3 x =
          rotate_back(g_.R_12, turn_back(q2, rotate_back(g_.R_01, turn_back(q1, column[0]))));
      finish(branch + side, q1, q2, {x.x, x.y}, open, beyond, away);
    }
  }

  void finish(int branch, const Angle& q1, const Angle& q2, const Angle& q3, const Doubles& open,
              Doubles beyond, Doubles away) {
    judge(0, q1, beyond, away);
    judge(1, q2, beyond, away);
    judge(2, q3, beyond, away);
    // Limits mean nothing to angles that do not exist.
    store(out_.beyond[branch] + at_, select(open > kSevenWithin, open, beyond));
    store(out_.open[branch] + at_, open);
    store(out_.away[branch] + at_, away);
    double (*const to)[kBlock] = out_.shoulder[branch];
    store(to[0] + at_, q1.c);
    store(to[1] + at_, q1.s);
    store(to[2] + at_, q2.c);
    store(to[3] + at_, q2.s);
    store(to[4] + at_, q3.c);
    store(to[5] + at_, q3.s);
  }

  void judge(int joint, const Angle& q, Doubles& beyond, Doubles& away) const {
    beyond = larger(beyond,
                    g_.half_cos[joint] - (g_.middle_cos[joint] * q.c + g_.middle_sin[joint] * q.s));
    away = larger(away, 1.0 - (goal_.near_cos[joint] * q.c + goal_.near_sin[joint] * q.s));
  }

  const SevenGeometry& g_;
  const SevenGoal& goal_;
  int at_;
  SevenBlock& out_;
  Angle q7_;
  Vec3 d_5_;  // from W to S, in frame 5
  Angle base6_;
  Doubles inverse6_;
};

inline void seven_block(const SevenGeometry& geometry, const SevenGoal& goal, const double* q7,
                        SevenBlock& out) {
  for (int at = 0; at < kBlock; at += kDoubles) {
    SevenLanes(geometry, goal, at, out).run(load(q7 + at));
  }
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
