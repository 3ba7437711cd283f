#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/axis_chain_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {

AxisChain::AxisChain(const Arm& arm) {
  JointVec q = JointVec::Zero(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    if (arm.joints[static_cast<std::size_t>(i)].type == JointType::slide) {
      const double middle = 0.5 * (arm.limits.lower[i] + arm.limits.upper[i]);
      q[i] = std::isfinite(middle) ? middle : 0.0;
    }
  }
  std::vector<Pose> X_WJ(arm.joints.size());
  X_WT = fk_all(arm, as_span(q), X_WJ);
  double open_slack = 0;
  for (int i = 0; i < arm.dof(); ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const double lower = arm.limits.lower[i];
    const double upper = arm.limits.upper[i];
    const Pose& X = X_WJ[static_cast<std::size_t>(i)];
    if (joint.type == JointType::slide) {
      open_slack += 0.5 * (upper - lower);
      slack += 0.5 * (upper - lower);
    } else {
      axes.push_back({X.p, X.R * joint.axis, lower, upper, open_slack});
      open_slack = 0;
    }
  }
  slack_after = open_slack;
}

namespace {

/// The length of a polyline with one point on each of several axes, as a convex function of their
/// places t along the axes; every piece counts sqrt(|d|^2 + epsilon^2), which is smooth.
class SmoothLength {
 public:
  SmoothLength(const HingeAxis* axes, int count) : axes_(axes), n_(count) {}

  Eigen::Vector3d point(const JointVec& t, int i) const {
    return axes_[i].p_W + t[i] * axes_[i].a_W;
  }

  double value(const JointVec& t, double epsilon) const {
    double sum = 0;
    for (int i = 0; i + 1 < n_; ++i) sum += smooth(point(t, i + 1) - point(t, i), epsilon);
    return sum;
  }

  /// Newton's step at `t`, with the decrease that it promises. A point's piece meets the next one's
  /// alone, so that the second derivatives are a tridiagonal matrix.
  std::pair<JointVec, double> newton_step(const JointVec& t, double epsilon) const {
    JointVec g = JointVec::Zero(n_);
    JointVec diagonal = JointVec::Constant(n_, 1e-9), beside = JointVec::Zero(n_);
    for (int i = 0; i + 1 < n_; ++i) {
      const Eigen::Vector3d& a = axes_[i].a_W;  // how d moves with its two ends: -a and b
      const Eigen::Vector3d& b = axes_[i + 1].a_W;
      const Eigen::Vector3d d = point(t, i + 1) - point(t, i);
      const double r = smooth(d, epsilon);
      const double pull_a = -a.dot(d) / r, pull_b = b.dot(d) / r;
      g[i] += pull_a;
      g[i + 1] += pull_b;
      diagonal[i] += (a.dot(a) - pull_a * pull_a) / r;
      diagonal[i + 1] += (b.dot(b) - pull_b * pull_b) / r;
      beside[i] = (-a.dot(b) - pull_a * pull_b) / r;
    }
    JointVec step = -g;
    for (int i = 1; i < n_; ++i) {
      const double share = beside[i - 1] / diagonal[i - 1];
      diagonal[i] -= share * beside[i - 1];
      step[i] -= share * step[i - 1];
    }
    step[n_ - 1] /= diagonal[n_ - 1];
    for (int i = n_ - 1; i-- > 0;) step[i] = (step[i] - beside[i] * step[i + 1]) / diagonal[i];
    return {step, -g.dot(step)};
  }

 private:
  static double smooth(const Eigen::Vector3d& d, double epsilon) {
    return std::sqrt(d.squaredNorm() + epsilon * epsilon);
  }

  const HingeAxis* axes_;
  int n_;
};

}  // namespace

std::vector<Eigen::Vector3d> shortest_polyline(const AxisChain& chain, int first, int last) {
  const int n = last - first + 1;
  const SmoothLength length(chain.axes.data() + first, n);
  JointVec t = JointVec::Zero(n);
  // Newton's method with halved steps while the smoothing shrinks. Any t gives a valid bound, so
  // that a loop cut short costs tightness only.
  for (double epsilon = 1; epsilon > 1e-11; epsilon *= 0.3) {
    for (int iteration = 0; iteration < 30; ++iteration) {
      const auto [step, decrease] = length.newton_step(t, epsilon);
      if (!(decrease > 1e-13)) break;
      const double before = length.value(t, epsilon);
      double share = 1;
      while (share > 1e-6 && length.value(t + share * step, epsilon) > before) share *= 0.5;
      if (share <= 1e-6) break;
      t += share * step;
    }
  }
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < n; ++i) points.push_back(length.point(t, i));
  return points;
}

DistanceRange distance_across(const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                              const Eigen::Vector3d& a, double lower, double upper) {
  // |u - R v|^2 = k + C cos + S sin.
  const double along = u.dot(a) * v.dot(a);
  const double k = u.squaredNorm() + v.squaredNorm() - 2 * along;
  const double C = -2 * (u.dot(v) - along);
  const double S = -2 * u.dot(a.cross(v));
  const double amplitude = std::hypot(C, S);
  const double peak = std::atan2(S, C);
  const auto meets = [&](double angle) {
    return angle + kFullTurn * std::ceil((lower - angle) / kFullTurn) <= upper;
  };
  const auto value = [&](double angle) { return k + C * std::cos(angle) + S * std::sin(angle); };
  const bool full = !(upper - lower < kFullTurn);
  const auto ends = full ? std::pair{k, k} : std::minmax({value(lower), value(upper)});
  const double high = full || meets(peak) ? k + amplitude : ends.second;
  const double low = full || meets(peak + std::numbers::pi) ? k - amplitude : ends.first;
  return {std::sqrt(std::max(low, 0.0)), std::sqrt(std::max(high, 0.0))};
}

}  // namespace mjarm
