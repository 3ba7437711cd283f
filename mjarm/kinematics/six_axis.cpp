#include "mjarm/kinematics/six_axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/kinematics/branches_internal.hpp"
#include "mjarm/kinematics/trig_internal.hpp"

namespace mjarm {
namespace {

using detail::arc_tangent;
using detail::sin_cos;
using detail::SinCos;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// R v, written out so that the compiler keeps it in line.
Vector3d times(const Eigen::Matrix3d& R, const Vector3d& v) noexcept {
  return {R(0, 0) * v.x() + R(0, 1) * v.y() + R(0, 2) * v.z(),
          R(1, 0) * v.x() + R(1, 1) * v.y() + R(1, 2) * v.z(),
          R(2, 0) * v.x() + R(2, 1) * v.y() + R(2, 2) * v.z()};
}

/// `v` turned by `a` about z.
Vector3d turn_z(const SinCos& a, const Vector3d& v) noexcept {
  return {a.c * v.x() - a.s * v.y(), a.s * v.x() + a.c * v.y(), v.z()};
}
Vector2d turn(const SinCos& a, const Vector2d& v) noexcept {
  return {a.c * v.x() - a.s * v.y(), a.s * v.x() + a.c * v.y()};
}

/// Rodrigues' formula: `v` turned by `a` about the unit vector `h`.
Vector3d turn_about(const Vector3d& h, const SinCos& a, const Vector3d& v) noexcept {
  return a.c * v + a.s * h.cross(v) + (1 - a.c) * h.dot(v) * h;
}

/// By how much a step misses, and why.
struct Miss {
  double amount = 0;  // [m] <= 0: it does not
  double bound = 0;
  IkErrc why = IkErrc::no_convergence;
  ReachShape shape = ReachShape::none;
};

}  // namespace

/// One query, walked from the shoulder to the wrist. Where a root of a square is missing, the
/// nearest point is taken and the amount kept, so that every walk ends in a configuration.
class SixAxis::Walk {
 public:
  Walk(const SixAxis& form, const detail::BranchQuery& query, detail::Branches& out) noexcept
      : form_(form),
        near_(query.near),
        out_(out),
        slack_(query.pos_tol + form.slack_),
        free_turn_(std::max(query.rot_tol, 1e-7)) {
    const Pose& X_WT = query.X_WT;
    const Eigen::Matrix3d& R_BW = form.X_BW_.R;
    p_BC_ = times(R_BW, times(X_WT.R, form.p_TC_) + X_WT.p) + form.X_BW_.p;
    e_B_ = times(R_BW, times(X_WT.R, form.h6_T_));
    f_B_ = times(R_BW, times(X_WT.R, form.side_T_));
  }

  void run() noexcept {
    const detail::ShoulderStep& step = form_.shoulder_;
    // The height of C in S is the constant one: -s1 x + c1 y = level.
    const double level = (step.height - step.tilt_cos * p_BC_.z()) / step.tilt_sin;
    const double x = p_BC_.x();
    const double y = p_BC_.y();
    const double r2 = x * x + y * y;
    const double r = std::sqrt(r2);
    if (r < kNearFree) out_.complete = false;
    if (r < slack_ && std::abs(level) < slack_) {  // C on axis 1: any q1 will do
      for (int i = 0; i < kSamples; ++i) with_q1(sin_cos(sample(0, i)), sample(0, i));
      return;
    }
    const double beyond = std::abs(level) - r;
    if (beyond >= 0) {
      shoulder_miss_ = {beyond, std::abs(level), IkErrc::inner_void, ReachShape::cylinder};
      const double k = (level < 0 ? -1 : 1) / std::max(r, 1e-300);
      with_q1({-x * k, y * k}, arc_tangent(-x * k, y * k));
      return;
    }
    const double w = std::sqrt((r - level) * (r + level));
    for (const double k : {w, -w}) {
      const SinCos q1{(k * y - x * level) / r2, (k * x + y * level) / r2};
      with_q1(q1, arc_tangent(q1.s, q1.c));
    }
  }

 private:
  static constexpr int kSamples = 12;
  // [m and rad] So near to where a joint is free, rounding decides whether it is: what is told of
  // the answers there is no proof.
  static constexpr double kNearFree = 1e-5;

  /// Values of a free joint: that of the seed first, then round the circle.
  double sample(int joint, int i) const noexcept {
    return form_.sign_[joint] * near_[joint] + i * (2 * std::numbers::pi / kSamples);
  }

  void with_q1(const SinCos& q1, double angle) noexcept {
    q_[0] = angle;
    elbow_miss_ = wrist_miss_ = {};
    const SinCos back{-q1.s, q1.c};
    const Eigen::Matrix3d& R_SB = form_.shoulder_.R_SB;
    e_S_ = times(R_SB, turn_z(back, e_B_));
    f_S_ = times(R_SB, turn_z(back, f_B_));
    const Vector3d p_SC = times(R_SB, turn_z(back, p_BC_));
    end_ = p_SC.head<2>() - form_.elbow_.p_shoulder;
    if (form_.parallel_) {
      wrist(e_S_, f_S_);
    } else {
      elbow(end_);
    }
  }

  /// The two ways to turn the tool's axis; then q6 or, where it is free, samples of it.
  void wrist(const Vector3d& e, const Vector3d& f) noexcept {
    const detail::WristStep& step = form_.wrist_;
    const double across2 = e.x() * e.x() + e.y() * e.y();
    const double level = e.z() - step.constant;
    const double w2 = across2 + step.excess + 2 * step.constant * e.z();
    wrist_miss_ = {};
    if (w2 < 0) {
      wrist_miss_ = {std::abs(level) - step.size, step.size, IkErrc::out_of_reach,
                     ReachShape::wrist_cone};
    }
    const double w = std::sqrt(std::max(w2, 0.0));
    const double scale = 1 / std::sqrt(level * level + w * w);
    const double turned = arc_tangent(w, level);
    const bool is_free = across2 < free_turn_ * free_turn_;
    for (const double k : {w, -w}) {
      const SinCos t{k * scale, level * scale};
      q_[4] = step.phase + (k < 0 ? -turned : turned);
      const Vector3d m = turn_about(step.h5, t, step.h6);
      const Vector3d u = turn_about(step.h5, t, step.side);
      const Vector3d v = turn_about(step.h5, t, step.side2);
      const double c = m.x() * e.x() + m.y() * e.y();
      const double s = m.x() * e.y() - m.y() * e.x();
      const double size2 = c * c + s * s;
      if (across2 < kNearFree * kNearFree) out_.complete = false;
      if (is_free) {
        free_wrist(m.z() > 0 ? 1 : -1, f, u, v);
      }
      if (size2 > 0) {
        const double inverse = 1 / std::sqrt(size2);
        with_wrist({s * inverse, c * inverse}, f, u, v);
      }
      if (k == 0) break;
    }
  }

  /// `a`: the turn about the first axis of the wrist, which leaves q6.
  void with_wrist(const SinCos& a, const Vector3d& f, const Vector3d& u,
                  const Vector3d& v) noexcept {
    const Vector3d y = turn_z({-a.s, a.c}, f);
    q_[5] = arc_tangent(v.dot(y), u.dot(y));
    q_[3] = arc_tangent(a.s, a.c);
    if (form_.parallel_) {
      elbow(end_ - turn(a, form_.p_4C_));
    } else {
      add();
    }
  }

  /// Axis 6 along the first axis of the wrist: a + sign q6 is given, each alone is free.
  void free_wrist(int sign, const Vector3d& f, const Vector3d& u, const Vector3d& v) noexcept {
    const double sum = sign * arc_tangent(v.dot(f), u.dot(f));
    const auto with = [&](double a) { with_wrist(sin_cos(a), f, u, v); };
    const double a_of_q6 = sum - sign * form_.sign_[5] * near_[5];
    const double a_of_seed =
        form_.sign_[3] * near_[3] +
        (form_.parallel_ ? form_.sign_[1] * near_[1] + form_.sign_[2] * near_[2] : 0.0);
    with(a_of_q6);
    with(a_of_seed);
    if (!form_.parallel_) {
      for (int i = 1; i < kSamples; ++i) with(sample(3, i));
      return;
    }
    // The elbow reaches where |end - rot(a) p_4C|^2 = sum2 - product cos(a - middle) is neither too
    // large nor too small: two intervals on either side of `middle`.
    const Vector2d& p = form_.p_4C_;
    const double product = 2 * end_.norm() * p.norm();
    const double sum2 = end_.squaredNorm() + p.squaredNorm();
    const double middle = arc_tangent(end_.y(), end_.x()) - arc_tangent(p.y(), p.x());
    const auto angle_at = [&](double distance) {
      const double c = (sum2 - distance * distance) / std::max(product, 1e-12);
      return std::acos(std::min(std::max(c, -1.0), 1.0));
    };
    const double first = angle_at(form_.elbow_.upper - form_.elbow_.lower);
    const double last = angle_at(form_.elbow_.upper + form_.elbow_.lower);
    for (const double a : {a_of_q6, a_of_seed}) {
      const double off = std::remainder(a - middle, 2 * std::numbers::pi);
      with(middle + std::copysign(std::min(std::max(std::abs(off), first), last), off));
    }
    for (int i = 0; i < kSamples; ++i) {
      const double off = first + (last - first) * (i / 2) / (kSamples / 2 - 1);
      with(middle + (i % 2 == 0 ? off : -off));
    }
  }

  /// The two ways to bend the elbow so that the two links end at `end`.
  void elbow(const Vector2d& end) noexcept {
    const detail::ElbowStep& step = form_.elbow_;
    const double r2 = end.squaredNorm();
    const double r = std::sqrt(r2);
    const double longest = step.upper + step.lower;
    const double shortest = std::abs(step.upper - step.lower);
    elbow_miss_ = {};
    if (r > longest) {
      elbow_miss_ = {r - longest, longest, IkErrc::out_of_reach, ReachShape::elbow_stretched};
    } else if (r < shortest) {
      elbow_miss_ = {shortest - r, shortest, IkErrc::inner_void, ReachShape::elbow_folded};
    }
    if (!is_wanted()) return;
    const double w2 = (longest - r) * (longest + r) * (r - shortest) * (r + shortest);
    const double w = 0.5 * std::sqrt(std::max(w2, 0.0));
    const double g = 0.5 * (r2 - step.upper * step.upper - step.lower * step.lower);
    const double bend = arc_tangent(w, g);
    const double lift = arc_tangent(w, step.upper * step.upper + g);
    if (r < kNearFree) out_.complete = false;
    if (r < slack_) {  // folded onto itself: any q2 will do
      for (int i = 0; i < kSamples; ++i) with_elbow(sample(1, i) + step.upper_angle, bend);
      return;
    }
    const double direction = arc_tangent(end.y(), end.x());
    with_elbow(direction - lift, bend);
    if (w > 0) with_elbow(direction + lift, -bend);
  }

  /// `upper`: direction of the upper link; `bend`: that of the lower link against it.
  void with_elbow(double upper, double bend) noexcept {
    const detail::ElbowStep& step = form_.elbow_;
    q_[1] = upper - step.upper_angle;
    q_[2] = bend + step.upper_angle - step.lower_angle;
    if (form_.parallel_) {
      add();
      return;
    }
    const SinCos q23 = sin_cos(q_[1] + q_[2]);
    const SinCos back{-q23.s, q23.c};
    wrist(times(form_.R_FS_, turn_z(back, e_S_)), times(form_.R_FS_, turn_z(back, f_S_)));
  }

  double missed() const noexcept {
    return std::max(shoulder_miss_.amount, 0.0) + std::max(elbow_miss_.amount, 0.0) +
           std::max(wrist_miss_.amount, 0.0);
  }
  /// False where neither a branch nor a better near miss can come of it.
  bool is_wanted() const noexcept {
    const double amount = missed();
    return amount <= slack_ || (out_.count == 0 && amount < out_.amount);
  }

  void add() noexcept {
    if (!is_wanted()) return;
    const double amount = missed();
    if (amount <= slack_) {
      if (double* row = out_.add()) write(row);
    }
    if (amount > 0 && amount < out_.amount) {
      const Miss* worst = &shoulder_miss_;
      if (elbow_miss_.amount > worst->amount) worst = &elbow_miss_;
      if (wrist_miss_.amount > worst->amount) worst = &wrist_miss_;
      out_.why = worst->why;
      out_.shape = worst->shape;
      out_.amount = amount;
      out_.bound = worst->bound;
      out_.has_best = true;
      write(out_.best);
    }
  }

  void write(double* row) const noexcept {
    for (int i = 0; i < 6; ++i) row[i] = form_.sign_[i] * q_[i];
    if (form_.parallel_) row[3] = form_.sign_[3] * (q_[3] - q_[1] - q_[2]);
  }

  const SixAxis& form_;
  const double* near_;
  detail::Branches& out_;
  const double slack_;      // [m] a clamped branch that misses by no more is kept
  const double free_turn_;  // [rad] axes nearer to parallel count as parallel
  Vector3d p_BC_, e_B_, f_B_;
  Vector3d e_S_, f_S_;
  Vector2d end_;
  Miss shoulder_miss_, elbow_miss_, wrist_miss_;
  double q_[6];  // [rad] along the axes of the form; parallel: q_[3] is q2 + q3 + q4
};

void SixAxis::branches(const detail::BranchQuery& query, detail::Branches& out) const noexcept {
  out.complete = is_exact();
  Walk(*this, query, out).run();
}

}  // namespace mjarm
