#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "mjarm/core/messages/trajectory.hpp"
#include "mjarm/trajectory/kept_limits_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kKeptEps = std::numeric_limits<double>::epsilon();
constexpr double kKeptRounding = 1e-6;  // share of a limit that may be lost to it

/// q, v, a and jerk of one joint.
using Moment = std::array<double, 4>;

/// One joint on one piece, as its polynomial.
class JointPiece {
 public:
  JointPiece(const Trajectory::Piece& piece, Eigen::Index joint) : h_(piece.duration) {
    for (std::size_t k = 0; k < c_.size(); ++k)
      c_[k] = piece.c(joint, static_cast<Eigen::Index>(k));
  }

  /// @param x  [s] since the piece began.
  [[nodiscard]] Moment at(double x) const {
    const auto& c = c_;
    return {c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))),
            c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5]))),
            2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5])),
            6 * c[3] + x * (24 * c[4] + x * 60 * c[5])};
  }

  /// Calls `look` with the moments between its ends in which something may be largest.
  template <class Look>
  void for_extremes(Look look) const {
    if (c_[4] == 0 && c_[5] == 0) {
      const double turn = -c_[2] / (3 * c_[3]);  // where the acceleration is 0
      if (turn > 0 && turn < h_) look(at(turn));
      return;
    }
    constexpr int kSamples = 8;
    for (int i = 1; i < kSamples; ++i) look(at(h_ * i / kSamples));
  }

 private:
  double h_;
  std::array<double, 6> c_;
};

/// What one joint may do.
struct Allowed {
  double v, a, j;
};

/// A start or end outside of the limits, or that cannot but overshoot them, widens them.
Allowed allowed(const JointLimits& limits, const JointState& start, const JointState& end,
                Eigen::Index i) {
  const double r = 0.5 / limits.jerk[i];
  const auto reach = [&](const JointState& x, double sign) {
    return std::abs(x.v[i] + sign * r * x.a[i] * std::abs(x.a[i]));
  };
  return {std::max({limits.velocity[i], std::abs(start.v[i]), reach(start, 1), std::abs(end.v[i]),
                    reach(end, -1)}),
          std::max({limits.acceleration[i], std::abs(start.a[i]), std::abs(end.a[i])}),
          limits.jerk[i]};
}

Result<void> broken(Eigen::Index joint, Msg limit, double share) {
  return fail(Errc::impossible, text(msg::trajectory_not_kept, joint + 1, text(limit), share));
}

class KeptJoint {
 public:
  KeptJoint(const Trajectory& motion, Allowed allowed, Eigen::Index joint, bool with_jerk)
      : motion_(motion), allowed_(allowed), joint_(joint), with_jerk_(with_jerk) {}

  [[nodiscard]] Result<void> check() {
    for (std::size_t i = 0; i < motion_.pieces(); ++i) {
      const Trajectory::Piece piece = motion_.piece(i);
      const JointPiece polynomial(piece, joint_);
      const Moment begin = polynomial.at(0);
      if (i > 0) add_jump(begin);
      before_ = polynomial.at(piece.duration);
      add(begin);
      add(before_);
      polynomial.for_extremes([&](const Moment& x) { add(x); });
    }
    if (motion_.pieces() > 0) {
      const JointState end = motion_.at(motion_.duration());
      add_jump({end.q[joint_], end.v[joint_], end.a[joint_], 0});
    }
    v_ /= allowed_.v;
    a_ /= allowed_.a;
    j_ /= allowed_.j;
    // Not a number is no share below any other.
    if (!(v_ <= 1 + kKeptRounding)) return broken(joint_, msg::trajectory_velocity, v_);
    if (!(a_ <= 1 + kKeptRounding)) return broken(joint_, msg::trajectory_acceleration, a_);
    if (with_jerk_ && !(j_ <= 1 + kKeptRounding)) return broken(joint_, msg::trajectory_jerk, j_);
    if (!(jump_ <= 1)) return fail(Errc::impossible, text(msg::trajectory_jumps, joint_ + 1));
    return {};
  }

 private:
  /// Larger, or not a number.
  static void raise(double& worst, double value) {
    if (!(value <= worst)) worst = value;
  }
  void add(const Moment& x) {
    raise(v_, std::abs(x[1]));
    raise(a_, std::abs(x[2]));
    raise(j_, std::abs(x[3]));
  }
  void add_jump(const Moment& after) {
    const double t = motion_.duration();
    const double q = 1e-7 + kKeptRounding * t * allowed_.v + 8 * kKeptEps * std::abs(after[0]);
    raise(jump_, std::abs(after[0] - before_[0]) / q);
    raise(jump_, std::abs(after[1] - before_[1]) / (kKeptRounding * (allowed_.v + t * allowed_.a)));
    if (!with_jerk_) return;
    raise(jump_, std::abs(after[2] - before_[2]) / (kKeptRounding * (allowed_.a + t * allowed_.j)));
  }

  const Trajectory& motion_;
  Allowed allowed_;
  Eigen::Index joint_;
  bool with_jerk_;
  Moment before_{};
  double v_ = 0, a_ = 0, j_ = 0;  // largest, in the end as shares of what is allowed
  double jump_ = 0;               // as a share of what rounding explains
};

}  // namespace

Result<void> check_kept(const Trajectory& motion, const JointLimits& limits, bool with_jerk) {
  if (!std::isfinite(motion.duration())) {
    return fail(Errc::impossible, text(msg::trajectory_jumps, 1));
  }
  const JointState end = motion.at(motion.duration()), start = motion.at(0);
  for (Eigen::Index i = 0; i < motion.dof(); ++i) {
    KeptJoint joint(motion, allowed(limits, start, end, i), i, with_jerk);
    if (auto kept = joint.check(); !kept) return kept;
  }
  return {};
}

}  // namespace mjarm::detail
