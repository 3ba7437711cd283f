#pragma once

#include <limits>

#include "mjarm/core/simd/functions.hpp"
#include "mjarm/kinematics/descent_block_internal.hpp"

/// The arithmetic of descend() for kDoubles configurations at a time. Included by one file for each
/// width of the registers.
namespace mjarm::detail {
inline namespace MJARM_LANES {

using namespace simd;

/// One step of kDoubles descents.
class LaneDescent {
 public:
  LaneDescent(const Chain& chain, const Pose& X_WT, const DescentOptions& options,
              DescentBlock& block, int offset)
      : chain_(chain), goal_(X_WT), options_(options), block_(block), at_(offset) {}

  void run() {
    forward();
    set_error();
    set_jacobian();
    hold_at_limits();
    solve();
    move();
  }

 private:
  static constexpr double kDamping = 0.1;  // as in descend()

  /// Axes and origins of the joints in the world, and the pose of the tool.
  void forward() {
    for (int k = 0; k < 9; ++k) R_[k] = splat(k % 4 == 0 ? 1.0 : 0.0);
    for (int k = 0; k < 3; ++k) p_[k] = splat(0.0);
    for (int i = 0; i < chain_.dof; ++i) {
      carry(chain_.X_PJ[static_cast<std::size_t>(i)]);
      for (int k = 0; k < 3; ++k) {
        axis_[i][k] = R_[6 + k];
        origin_[i][k] = p_[k];
      }
      const Doubles q = load(block_.q[i] + at_);
      if (chain_.slide[static_cast<std::size_t>(i)]) {
        for (int k = 0; k < 3; ++k) p_[k] += q * R_[6 + k];
        continue;
      }
      Doubles s, c;
      sine_cosine(q, s, c);
      for (int k = 0; k < 3; ++k) {
        const Doubles x = R_[k];
        R_[k] = c * x + s * R_[3 + k];
        R_[3 + k] = c * R_[3 + k] - s * x;
      }
    }
    carry(chain_.X_JT);
  }

  /// Carries the pose over to the next frame.
  void carry(const Pose& X) {
    for (int k = 0; k < 3; ++k) {
      p_[k] += R_[k] * X.p[0] + R_[3 + k] * X.p[1] + R_[6 + k] * X.p[2];
    }
    for (int k = 0; k < 3; ++k) {
      const Doubles x = R_[k], y = R_[3 + k], z = R_[6 + k];
      for (int j = 0; j < 3; ++j) R_[3 * j + k] = x * X.R(0, j) + y * X.R(1, j) + z * X.R(2, j);
    }
  }

  /// Position error in units of the characteristic length, and 2 sin(t / 2) times the axis of the
  /// turn that is missing.
  void set_error() {
    const double w = 1 / options_.length;
    for (int k = 0; k < 3; ++k) e_[k] = w * (goal_.p[k] - p_[k]);
    error_ = e_[0] * e_[0] + e_[1] * e_[1] + e_[2] * e_[2];
    if (options_.task == IkTask::position) {
      for (int k = 3; k < 6; ++k) e_[k] = splat(0.0);
      return;
    }
    for (int k = 3; k < 6; ++k) e_[k] = splat(0.0);
    const bool axis = options_.task == IkTask::axis;
    Doubles cosine = compare_axis(2);
    if (!axis) {
      cosine += compare_axis(0);
      cosine += compare_axis(1);
      cosine = 0.5 * (cosine - 1.0);
    }
    const Doubles f = (axis ? 1.0 : 0.5) * square_root(2.0 / larger(1.0 + cosine, splat(1e-12)));
    for (int k = 3; k < 6; ++k) e_[k] *= f;
    const Doubles turn = e_[3] * e_[3] + e_[4] * e_[4] + e_[5] * e_[5];
    // Half a turn is the farthest, though its axis cannot be read from the difference.
    error_ += select(cosine < 0.0, 2.0 - 2.0 * cosine, turn);
  }

  /// Adds axis `j` of the tool cross that of the goal to the error; returns their cosine.
  Doubles compare_axis(int j) {
    const Doubles x = R_[3 * j], y = R_[3 * j + 1], z = R_[3 * j + 2];
    const double a = goal_.R(0, j), b = goal_.R(1, j), c = goal_.R(2, j);
    e_[3] += c * y - b * z;
    e_[4] += a * z - c * x;
    e_[5] += b * x - a * y;
    return a * x + b * y + c * z;
  }

  void set_jacobian() {
    const double w = 1 / options_.length;
    const double turns = options_.task == IkTask::position ? 0 : 1;
    for (int i = 0; i < chain_.dof; ++i) {
      const Doubles* a = axis_[i];
      Doubles* J = J_[i];
      if (chain_.slide[static_cast<std::size_t>(i)]) {
        for (int k = 0; k < 3; ++k) {
          J[k] = w * a[k];
          J[3 + k] = splat(0.0);
        }
        continue;
      }
      const Doubles x = w * (p_[0] - origin_[i][0]);
      const Doubles y = w * (p_[1] - origin_[i][1]);
      const Doubles z = w * (p_[2] - origin_[i][2]);
      J[0] = a[1] * z - a[2] * y;
      J[1] = a[2] * x - a[0] * z;
      J[2] = a[0] * y - a[1] * x;
      for (int k = 0; k < 3; ++k) J[3 + k] = turns * a[k];
    }
    if (options_.task == IkTask::axis) free_turn();
  }

  /// Takes the turns about the tool's z axis out of the Jacobian.
  void free_turn() {
    const Doubles* z = R_ + 6;
    for (int i = 0; i < chain_.dof; ++i) {
      Doubles* turn = J_[i] + 3;
      const Doubles about = turn[0] * z[0] + turn[1] * z[1] + turn[2] * z[2];
      for (int k = 0; k < 3; ++k) turn[k] -= about * z[k];
    }
  }

  /// Drops the columns of joints at a limit that the gradient would push outwards.
  void hold_at_limits() {
    if (!options_.limits) return;
    for (int i = 0; i < chain_.dof; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (chain_.full_turn[k]) continue;
      Doubles* J = J_[i];
      const Doubles q = load(block_.q[i] + at_);
      Doubles pull = J[0] * e_[0];
      for (int r = 1; r < 6; ++r) pull += J[r] * e_[r];
      const DoubleMask held =
          ((q <= chain_.lower[k]) & (pull < 0.0)) | ((q >= chain_.upper[k]) & (pull > 0.0));
      for (int r = 0; r < 6; ++r) J[r] = select(held, splat(0.0), J[r]);
    }
  }

  /// Solves (J J^T + lambda I) y = e by Cholesky's factors without roots.
  void solve() {
    Doubles A[6][6];
    const Doubles lambda = kDamping * error_ + 1e-12;
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c <= r; ++c) A[r][c] = r == c ? lambda : splat(0.0);
    }
    for (int i = 0; i < chain_.dof; ++i) {
      for (int r = 0; r < 6; ++r) {
        for (int c = 0; c <= r; ++c) A[r][c] += J_[i][r] * J_[i][c];
      }
    }
    Doubles inverse[6];
    for (int c = 0; c < 6; ++c) {
      inverse[c] = 1.0 / A[c][c];
      for (int r = c + 1; r < 6; ++r) {
        const Doubles f = A[r][c] * inverse[c];
        for (int k = c + 1; k <= r; ++k) A[r][k] -= f * A[k][c];
      }
    }
    for (int r = 0; r < 6; ++r) y_[r] = e_[r];
    for (int c = 0; c < 6; ++c) {
      const Doubles f = y_[c] * inverse[c];
      for (int r = c + 1; r < 6; ++r) y_[r] -= A[r][c] * f;
    }
    for (int r = 5; r >= 0; --r) {
      for (int k = r + 1; k < 6; ++k) y_[r] -= A[k][r] * y_[k];
      y_[r] *= inverse[r];
    }
  }

  void move() {
    for (int i = 0; i < chain_.dof; ++i) {
      const auto k = static_cast<std::size_t>(i);
      Doubles q = load(block_.q[i] + at_);
      for (int r = 0; r < 6; ++r) q += J_[i][r] * y_[r];
      if (options_.limits && !chain_.full_turn[k]) {
        q = smaller(larger(q, splat(chain_.lower[k])), splat(chain_.upper[k]));
      }
      store(block_.next[i] + at_, q);
    }
    store(block_.error + at_, error_);
  }

  const Chain& chain_;
  const Pose& goal_;
  const DescentOptions& options_;
  DescentBlock& block_;
  int at_;
  Doubles R_[9], p_[3];  // the frame reached, columns of its axes
  Doubles axis_[kMaxDof][3], origin_[kMaxDof][3];
  Doubles J_[kMaxDof][6];
  Doubles e_[6], y_[6], error_;
};

inline void descent_step(const Chain& chain, const Pose& X_WT, const DescentOptions& options,
                         DescentBlock& block) {
  for (int at = 0; at < kBlock; at += kDoubles) LaneDescent(chain, X_WT, options, block, at).run();
}

}  // namespace MJARM_LANES
}  // namespace mjarm::detail
