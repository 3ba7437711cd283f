#include <cmath>
#include <span>

#include "mjarm/kinematics/descent_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Rotation vector that turns `R` into `R_goal`, in the world's axes; exact near 0 and near pi.
Vector3d rotation_error(const Matrix3d& R, const Matrix3d& R_goal) noexcept {
  const Vector3d v = 0.5 * (R.col(0).cross(R_goal.col(0)) + R.col(1).cross(R_goal.col(1)) +
                            R.col(2).cross(R_goal.col(2)));
  const double c = 0.5 * (R.cwiseProduct(R_goal).sum() - 1);
  const double s = v.norm();
  if (s > 1e-6) return v * (std::atan2(s, c) / s);
  if (c > 0) return v;
  // Near pi the axis is read from the symmetric part, E + E^T = 2 a a^T (1 - c) + 2 c I.
  const Matrix3d E = R_goal * R.transpose();
  Eigen::Index k = 0;
  E.diagonal().maxCoeff(&k);
  Vector3d axis = 0.5 * (E.col(k) + E.row(k).transpose());
  axis[k] += 1;
  return axis.normalized() * std::atan2(s, c);
}

/// Rotation vector that turns the unit vector `z` into `z_goal` the shortest way.
Vector3d direction_error(const Vector3d& z, const Vector3d& z_goal) noexcept {
  const Vector3d v = z.cross(z_goal);
  const double c = z.dot(z_goal);
  const double s = v.norm();
  if (s > 1e-6) return v * (std::atan2(s, c) / s);
  if (c > 0) return v;
  Eigen::Index k = 0;  // half a turn, about any axis across
  z.cwiseAbs().minCoeff(&k);
  return z.cross(Vector3d::Unit(k)).normalized() * std::atan2(s, c);
}

/// Takes out of the Jacobian's columns `J` and the error `e` what the task leaves free.
void free_rotation(IkTask task, const Matrix3d& R, const Matrix3d& R_goal, std::span<Vector6> J,
                   Vector6& e) noexcept {
  const bool axis = task == IkTask::axis;
  const Vector3d z = R.col(2);
  for (Vector6& column : J) {
    auto turn = column.tail<3>();
    turn -= axis ? Vector3d(turn.dot(z) * z) : Vector3d(turn);
  }
  e.tail<3>() = axis ? direction_error(z, R_goal.col(2)) : Vector3d(Vector3d::Zero());
}

/// The loop of one descent for N joints; N = 0: for any number. Fixed sizes let the compiler
/// unroll.
template <int N>
class Walker {
 public:
  Walker(const Chain& chain, const Pose& X_goal, const DescentOptions& options) noexcept
      : chain_(chain), goal_(X_goal), options_(options), n_(N > 0 ? N : chain.dof) {}

  Descent run(const JointVec& q_start) noexcept {
    Descent out;
    out.q = q_start;
    for (int i = 0; i < n(); ++i) q_[i] = q_start[i];
    out.error = evaluate();
    keep(out);
    double mark = out.error;
    int since_mark = 0;
    while (!out.converged || error_ > kPolish) {
      if (out.iterations == options_.max_iterations || !step()) break;
      ++out.iterations;
      const double error = evaluate();
      const bool better = error < out.error;
      if (better) {
        out.error = error;
        keep(out);
      }
      if (out.converged && !better) break;
      if (out.error < kProgress * mark) {
        mark = out.error;
        since_mark = 0;
      } else if (++since_mark == kPatience) {
        break;
      }
    }
    return out;
  }

 private:
  static constexpr int kSize = N > 0 ? N : kMaxDof;
  static constexpr double kDamping = 0.1;   // lambda / error, see step()
  static constexpr double kPolish = 1e-22;  // [rad^2] go on to here while it is cheap
  static constexpr double kProgress = 0.5;  // the error must fall by this factor ...
  static constexpr int kPatience = 8;       // ... within so many steps, or the start is given up

  int n() const noexcept { return N > 0 ? N : n_; }
  std::size_t size() const noexcept { return static_cast<std::size_t>(n()); }

  /// Forward pass at q_: fills the Jacobian (position rows weighted) and the error vector.
  double evaluate() noexcept {
    Matrix3d R = Matrix3d::Identity();
    Vector3d p = Vector3d::Zero();
    Vector3d origin[kSize];
    Vector3d axis[kSize];
    for (int i = 0; i < n(); ++i) {
      const Pose& X = chain_.X_PJ[static_cast<std::size_t>(i)];
      p += R * X.p;
      R = R * X.R;
      axis[i] = R.col(2);
      origin[i] = p;
      if (chain_.slide[static_cast<std::size_t>(i)]) {
        p += q_[i] * axis[i];
      } else {
        const double s = std::sin(q_[i]);
        const double c = std::cos(q_[i]);
        const Vector3d x = R.col(0);
        R.col(0) = c * x + s * R.col(1);
        R.col(1) = c * R.col(1) - s * x;
      }
    }
    p += R * chain_.X_JT.p;
    R = R * chain_.X_JT.R;
    const double w = 1 / options_.length;
    for (int i = 0; i < n(); ++i) {
      if (chain_.slide[static_cast<std::size_t>(i)]) {
        J_[i].template head<3>() = w * axis[i];
        J_[i].template tail<3>().setZero();
      } else {
        J_[i].template head<3>() = w * axis[i].cross(p - origin[i]);
        J_[i].template tail<3>() = axis[i];
      }
    }
    e_.template head<3>() = w * (goal_.p - p);
    e_.template tail<3>() = rotation_error(R, goal_.R);
    if (options_.task != IkTask::pose) free_rotation(options_.task, R, goal_.R, {J_, size()}, e_);
    error_ = e_.squaredNorm();
    return error_;
  }

  /// One damped step: (J^T J + lambda I) dq = J^T e with lambda in proportion to the squared error
  /// (S. K. Chan and P. D. Lawrence, ICRA 1988), so that it turns into Newton's near the goal.
  /// Joints at a limit that the step would push outwards are held. False where no joint can move.
  bool step() noexcept {
    double g[kSize];
    bool held[kSize];
    for (int i = 0; i < n(); ++i) {
      g[i] = J_[i].dot(e_);
      held[i] =
          is_limited(i) && ((q_[i] <= lower(i) && g[i] < 0) || (q_[i] >= upper(i) && g[i] > 0));
    }
    if (!solve_for(held, g)) return false;
    if (options_.share && options_.limits && !share(held, g)) return false;
    double moved = 0;
    for (int i = 0; i < n(); ++i) {
      double q = q_[i] + g[i];
      if (is_limited(i)) q = std::fmin(std::fmax(q, lower(i)), upper(i));
      moved += std::abs(q - q_[i]);
      q_[i] = q;
    }
    return moved > 0;
  }

  /// Turns the gradient `g` into the step of the joints that are not held; that of the others is 0.
  bool solve_for(const bool (&held)[kSize], double (&g)[kSize]) const noexcept {
    const double lambda = kDamping * error_ + options_.damping;
    double A[kSize][kSize];
    for (int i = 0; i < n(); ++i) {
      for (int j = 0; j < i; ++j) A[i][j] = held[i] || held[j] ? 0.0 : J_[i].dot(J_[j]);
      A[i][i] = held[i] ? 1.0 : J_[i].squaredNorm() + lambda;
      if (held[i]) g[i] = 0;
    }
    return solve_in_place(A, g);
  }

  /// Of a step `g` that carries joints past their limits: the worst of them goes to its limit and
  /// no farther, the step of the others is solved for what that leaves of the error; and so on,
  /// until none is carried past.
  bool share(bool (&held)[kSize], double (&g)[kSize]) const noexcept {
    double fixed[kSize] = {};
    Vector6 left = e_;
    for (int round = 0; round < n(); ++round) {
      int worst = -1;
      double beyond = 0;
      for (int i = 0; i < n(); ++i) {
        if (held[i] || !is_limited(i)) continue;
        const double past = std::fmax(q_[i] + g[i] - upper(i), lower(i) - q_[i] - g[i]);
        if (past > beyond) {
          beyond = past;
          worst = i;
        }
      }
      if (worst < 0) break;
      fixed[worst] = (g[worst] > 0 ? upper(worst) : lower(worst)) - q_[worst];
      held[worst] = true;
      left -= fixed[worst] * J_[worst];
      for (int i = 0; i < n(); ++i) g[i] = J_[i].dot(left);
      if (!solve_for(held, g)) return false;
    }
    for (int i = 0; i < n(); ++i) g[i] += fixed[i];
    return true;
  }

  /// Cholesky factorisation of the lower half of A and both substitutions; the answer is left in
  /// `b`.
  bool solve_in_place(double (&A)[kSize][kSize], double (&b)[kSize]) const noexcept {
    for (int j = 0; j < n(); ++j) {
      double d = A[j][j];
      for (int k = 0; k < j; ++k) d -= A[j][k] * A[j][k];
      if (!(d > 0)) return false;
      const double inverse = 1 / std::sqrt(d);
      A[j][j] = inverse;
      for (int i = j + 1; i < n(); ++i) {
        double s = A[i][j];
        for (int k = 0; k < j; ++k) s -= A[i][k] * A[j][k];
        A[i][j] = s * inverse;
      }
    }
    for (int i = 0; i < n(); ++i) {
      for (int k = 0; k < i; ++k) b[i] -= A[i][k] * b[k];
      b[i] *= A[i][i];
    }
    for (int i = n() - 1; i >= 0; --i) {
      for (int k = i + 1; k < n(); ++k) b[i] -= A[k][i] * b[k];
      b[i] *= A[i][i];
    }
    return true;
  }

  void keep(Descent& out) const noexcept {
    for (int i = 0; i < n(); ++i) out.q[i] = q_[i];
    out.pos_err = options_.length * e_.template head<3>().norm();
    out.rot_err = e_.template tail<3>().norm();
    out.converged = out.pos_err <= options_.pos_tol && out.rot_err <= options_.rot_tol;
  }

  bool is_limited(int i) const noexcept {
    return options_.limits && !chain_.full_turn[static_cast<std::size_t>(i)];
  }
  double lower(int i) const noexcept { return chain_.lower[static_cast<std::size_t>(i)]; }
  double upper(int i) const noexcept { return chain_.upper[static_cast<std::size_t>(i)]; }

  const Chain& chain_;
  const Pose& goal_;
  const DescentOptions& options_;
  int n_;
  double q_[kSize];
  Vector6 J_[kSize];
  Vector6 e_;
  double error_ = 0;
};

}  // namespace

Descent descend(const Chain& chain, const Pose& X_WT, const JointVec& q_start,
                const DescentOptions& options) noexcept {
  if (chain.dof == 6) return Walker<6>(chain, X_WT, options).run(q_start);
  if (chain.dof == 7) return Walker<7>(chain, X_WT, options).run(q_start);
  return Walker<0>(chain, X_WT, options).run(q_start);
}

}  // namespace mjarm::detail
