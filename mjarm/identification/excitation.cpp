#include "mjarm/identification/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "mjarm/control/regressor.hpp"
#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/identification.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/moved_bodies.hpp"

namespace mjarm {
namespace {

constexpr double kHighest = 0.4;      // [Hz] of the series
constexpr double kKnotStep = 0.05;    // [s]
constexpr double kLimitSpare = 0.02;  // [rad or m]

/// q(t) = start + sum over l of a_l (sin l w t) / (l w) - b_l (cos l w t - 1) / (l w).
struct FourierSeries {
  double omega = 1;  // [rad/s]
  JointVec start;
  Eigen::MatrixXd a, b;  // (dof, harmonics) [rad/s or m/s]

  [[nodiscard]] JointState at(double t) const {
    JointState out = JointState::at_rest(start);
    out.a.setZero();
    for (Eigen::Index l = 0; l < a.cols(); ++l) {
      const double w = static_cast<double>(l + 1) * omega, s = std::sin(w * t), c = std::cos(w * t);
      out.q += (a.col(l) * s - b.col(l) * (c - 1)) / w;
      out.v += a.col(l) * c + b.col(l) * s;
      out.a += w * (b.col(l) * c - a.col(l) * s);
    }
    return out;
  }
};

/// Random coefficients with velocity and acceleration zero at t = 0, and so at the end.
FourierSeries random_series(const JointVec& start, double seconds, Rng& rng) {
  const auto harmonics = static_cast<Eigen::Index>(std::clamp(kHighest * seconds, 3.0, 16.0));
  FourierSeries out{2 * std::numbers::pi / seconds, start, {}, {}};
  const Eigen::VectorXd order =
      Eigen::VectorXd::LinSpaced(harmonics, 1, static_cast<double>(harmonics));
  out.a.resize(start.size(), harmonics);
  out.b.resize(start.size(), harmonics);
  for (Eigen::Index j = 0; j < start.size(); ++j) {
    for (Eigen::Index l = 0; l < harmonics; ++l) {
      out.a(j, l) = rng.normal();
      out.b(j, l) = rng.normal();
    }
    out.a.row(j).array() -= out.a.row(j).mean();
    out.b.row(j) -= out.b.row(j).dot(order) / order.squaredNorm() * order.transpose();
  }
  return out;
}

/// Makes each joint go as far and as fast as it may, and no farther than `reach`.
void fit(FourierSeries& series, const JointLimits& limits, double seconds, double share,
         double reach) {
  constexpr int kSamples = 200;
  const Eigen::Index n = series.start.size();
  JointVec low = JointVec::Zero(n), high = low, v = low, a = low;
  for (int i = 0; i < kSamples; ++i) {
    const JointState state = series.at(seconds * i / kSamples);
    low = low.cwiseMin(state.q - series.start);
    high = high.cwiseMax(state.q - series.start);
    v = v.cwiseMax(state.v.cwiseAbs());
    a = a.cwiseMax(state.a.cwiseAbs());
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const double up = limits.upper[j] - kLimitSpare - series.start[j],
                 down = series.start[j] - limits.lower[j] - kLimitSpare;
    const double factor =
        std::min({reach / std::max(high[j], -low[j]), std::max(0.0, up) / high[j],
                  std::max(0.0, down) / -low[j], share * limits.velocity[j] / v[j],
                  share * limits.acceleration[j] / a[j]});
    series.a.row(j) *= factor;
    series.b.row(j) *= factor;
  }
}

bool is_valid(const FourierSeries& series, double seconds, const ExcitationOptions& options) {
  if (!options.valid) return true;
  const int count = static_cast<int>(seconds / kKnotStep);
  for (int i = 0; i < count; ++i) {
    const JointVec q = series.at(seconds * i / count).q;
    if (!options.valid(as_span(q))) return false;
  }
  return true;
}

/// Condition number of the equations, each unknown in its own scale.
double condition(const FourierSeries& series, double seconds, const Arm& arm,
                 const BaseColumns& base, const Eigen::Vector3d& gravity) {
  constexpr int kSamples = 80;
  const int n = arm.dof(), kept = static_cast<int>(base.kept.size());
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(kSamples * n, kept + 2 * n);
  for (int i = 0; i < kSamples; ++i) {
    const JointState state = series.at(seconds * (i + 0.5) / kSamples);
    W.block(i * n, 0, n, kept) = regressor_at(arm, gravity, state).links(Eigen::all, base.kept);
    for (int j = 0; j < n; ++j) {
      W(i * n + j, kept + j) = state.v[j] > 0 ? 1 : -1;
      W(i * n + j, kept + n + j) = state.v[j];
    }
    W.middleRows(i * n, n) = arm.limits.torque.cwiseInverse().asDiagonal() * W.middleRows(i * n, n);
  }
  Eigen::MatrixXd normal = W.transpose() * W;
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  normal = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::VectorXd values = symmetric_eigen(normal).values;
  return std::sqrt(values.tail<1>()[0] / std::max(values[0], 1e-300));
}

Result<Trajectory> as_trajectory(const FourierSeries& series, double seconds) {
  const int count = static_cast<int>(std::ceil(seconds / kKnotStep));
  std::vector<double> times;
  std::vector<JointState> knots;
  for (int i = 0; i <= count; ++i) {
    times.push_back(seconds * i / count);
    knots.push_back(series.at(times.back()));
  }
  // Exactly, where the sums leave a rounding.
  knots.front() = knots.back() = JointState::at_rest(series.start);
  return Trajectory::through(times, knots);
}

}  // namespace

Result<Trajectory> excitation(const Model& model, const Arm& arm, const JointVec& q_start,
                              const ExcitationOptions& options) {
  if (!(options.seconds >= kLeastExcitation && options.seconds <= kMostExcitation)) {
    return fail(Errc::bad_input, text(msg::identification_bad_seconds, kLeastExcitation,
                                      kMostExcitation, options.seconds));
  }
  const Eigen::Vector3d gravity = gravity_of(model);
  const BaseColumns base = base_columns(arm, gravity);
  Rng rng(options.seed);
  int tried = 0;
  for (const double size : {1.0, 0.7, 0.5, 0.35, 0.25, 0.15}) {
    std::optional<FourierSeries> best;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < options.tries; ++i, ++tried) {
      FourierSeries series = random_series(q_start, options.seconds, rng);
      fit(series, arm.limits, options.seconds, options.share, size * options.reach);
      if (!is_valid(series, options.seconds, options)) continue;
      const double number = condition(series, options.seconds, arm, base, gravity);
      if (number >= least) continue;
      least = number;
      best = std::move(series);
    }
    if (best) return as_trajectory(*best, options.seconds);
  }
  return fail(Errc::impossible, text(msg::identification_no_free_motion, tried));
}

Result<Trajectory> free_excitation(const Model& model, const Arm& arm, const JointVec& q_start,
                                   const ClearanceCheck& clearance,
                                   const ExcitationOptions& options) {
  constexpr double kLook = 0.01;  // [s] from look to look
  if (!clearance) return excitation(model, arm, q_start, options);
  ExcitationOptions free = options;
  free.valid = [&](std::span<const double> q) {
    return (!options.valid || options.valid(q)) && clearance(q).distance > kExcitationClearance;
  };
  Result<Trajectory> motion = excitation(model, arm, q_start, free);
  if (!motion) return motion;
  for (double t = 0; t < options.seconds; t += kLook) {
    const JointVec q = motion->at(t).q;
    if (clearance.is_free(as_span(q))) continue;
    return fail(Errc::impossible, text(msg::identification_touches, t));
  }
  return motion;
}

}  // namespace mjarm
