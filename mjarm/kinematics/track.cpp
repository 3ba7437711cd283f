#include "mjarm/kinematics/track.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The symmetric system of a step, of six rows or, for fewer joints, of one a
/// joint.
class Normal {
 public:
  Normal(const Jacobian& J, const bool* held) noexcept
      : rows_(std::min<int>(6, static_cast<int>(J.cols()))) {
    for (int i = 0; i < rows_; ++i) {
      for (int j = 0; j <= i; ++j) A_[i][j] = 0;
    }
    if (J.cols() >= 6) {
      for (Eigen::Index c = 0; c < J.cols(); ++c) {
        if (held[c]) continue;
        const double* column = J.col(c).data();
        for (int i = 0; i < 6; ++i) {
          for (int j = 0; j <= i; ++j) A_[i][j] += column[i] * column[j];
        }
      }
      return;
    }
    for (int i = 0; i < rows_; ++i) {
      for (int j = 0; j <= i; ++j) A_[i][j] = held[i] || held[j] ? 0 : J.col(i).dot(J.col(j));
    }
  }

  /// Factors A + d2 I = L L^T; returns the product of L's diagonal: the
  /// manipulability where d2 = 0.
  double factor(double d2) noexcept {
    double product = 1;
    for (int j = 0; j < rows_; ++j) {
      double d = A_[j][j] + d2;
      for (int k = 0; k < j; ++k) d -= L_[j][k] * L_[j][k];
      const double root = std::sqrt(std::max(d, 1e-18));
      product *= root;
      L_[j][j] = 1 / root;
      for (int i = j + 1; i < rows_; ++i) {
        double s = A_[i][j];
        for (int k = 0; k < j; ++k) s -= L_[i][k] * L_[j][k];
        L_[i][j] = s / root;
      }
    }
    return product;
  }

  void solve(double (&b)[6]) const noexcept {
    for (int i = 0; i < rows_; ++i) {
      for (int k = 0; k < i; ++k) b[i] -= L_[i][k] * b[k];
      b[i] *= L_[i][i];
    }
    for (int i = rows_ - 1; i >= 0; --i) {
      for (int k = i + 1; k < rows_; ++k) b[i] -= L_[k][i] * b[k];
      b[i] *= L_[i][i];
    }
  }

  [[nodiscard]] int rows() const noexcept { return rows_; }

 private:
  int rows_;
  double A_[6][6], L_[6][6];
};

/// The damped step for `e`; `damping` returns what was used.
JointVec damped_step(const Jacobian& J, const Vector6& e, const bool* held, double threshold,
                     double max, double& damping) noexcept {
  Normal normal(J, held);
  const double m = normal.factor(1e-14);
  damping = m < threshold ? max * std::sqrt(1 - m / threshold) : 0;
  if (damping > 0) normal.factor(damping * damping);
  JointVec dq(J.cols());
  double b[6] = {};
  const bool wide = J.cols() >= 6;
  for (int i = 0; i < normal.rows(); ++i) b[i] = wide ? e[i] : held[i] ? 0 : J.col(i).dot(e);
  normal.solve(b);
  for (Eigen::Index c = 0; c < J.cols(); ++c) {
    double sum = 0;
    for (int i = 0; i < 6; ++i) sum += J(i, c) * b[i];
    dq[c] = held[c] ? 0 : wide ? sum : b[c];
  }
  return dq;
}

}  // namespace

Tracker::Tracker(const Arm& arm, const TrackOptions& options)
    : chain_(Chain(arm)),
      lower_(arm.limits.lower),
      upper_(arm.limits.upper),
      options_(options),
      max_(options.dt * options.speed_share * arm.limits.velocity),
      length_(detail::characteristic_length(Chain(arm))) {
  const Chain chain(arm);
  if (chain.dof == 0) return;
  // What "far from a singularity" means for this arm: the best of many
  // configurations.
  Rng rng(1);
  const JointVec middle = JointVec::Zero(chain_.dof);
  const bool held[kMaxDof] = {};
  for (int i = 0; i < 256; ++i) {
    const JointVec q = detail::random_start(chain, middle, rng);
    Jacobian J = fk_jacobian(chain_, as_span(q)).J_W;
    J.topRows<3>() /= length_;
    threshold_ = std::max(threshold_, options_.near_singular * Normal(J, held).factor(1e-14));
  }
}

TrackStep Tracker::step(const Pose& X_WT, std::span<const double> q) const noexcept {
  TrackStep out;
  const bool fits = q.size() == static_cast<std::size_t>(chain_.dof) && chain_.dof > 0;
  out.q = fits ? joint_vec(q) : JointVec::Zero(chain_.dof);
  if (!fits || !out.q.allFinite() || !X_WT.p.allFinite() || !X_WT.R.allFinite()) return out;
  if (!(X_WT.R.transpose() * X_WT.R).isIdentity(1e-6) || X_WT.R.determinant() < 0) return out;
  out.ok = true;
  FkJacobian now = fk_jacobian(chain_, q);
  now.J_W.topRows<3>() /= length_;
  Vector6 e;
  e.head<3>() = X_WT.p - now.X_WT.p;
  e.tail<3>() = rotation_log(X_WT.R * now.X_WT.R.transpose());
  out.pos_err = e.head<3>().norm();
  out.rot_err = e.tail<3>().norm();
  e *= options_.gain;
  e.head<3>() /= length_;

  bool held[kMaxDof] = {};
  JointVec dq;
  for (;;) {
    dq = damped_step(now.J_W, e, held, threshold_, options_.damping, out.damping);
    const int before = out.held;
    for (int i = 0; i < chain_.dof; ++i) {
      const bool outwards =
          (dq[i] > 0 && out.q[i] >= upper_[i]) || (dq[i] < 0 && out.q[i] <= lower_[i]);
      if (outwards && !held[i]) {
        held[i] = true;
        ++out.held;
      }
    }
    if (out.held == before) break;
  }
  for (int i = 0; i < chain_.dof; ++i) {
    if (std::abs(dq[i]) * out.speed_scale > max_[i]) out.speed_scale = max_[i] / std::abs(dq[i]);
  }
  for (int i = 0; i < chain_.dof; ++i) {
    const double to = out.q[i] + out.speed_scale * dq[i];
    out.q[i] = std::min(std::max(to, lower_[i]), upper_[i]);
  }
  return out;
}

}  // namespace mjarm
