#include <algorithm>
#include <cmath>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/messages/identification.hpp"
#include "mjarm/identification/smooth_log_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kHalfWindow = 0.1;  // [s]
constexpr int kLeastHalf = 5;        // rows
constexpr double kShortest = 2;      // [s]

/// Rows: value, first and second derivative in the middle of 2 half + 1 values.
Eigen::MatrixXd smoothing_weights(int half, double timestep) {
  constexpr int kOrder = 4;
  const Eigen::Index count = 2 * half + 1;
  Eigen::MatrixXd powers(count, kOrder + 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double u = static_cast<double>(i - half) / half;
    for (int k = 0; k <= kOrder; ++k) powers(i, k) = std::pow(u, k);
  }
  const Eigen::MatrixXd fit =
      solve_symmetric(powers.transpose() * powers, powers.transpose());  // coefficients of u^k
  const double span = half * timestep;
  Eigen::MatrixXd out(3, count);
  out << fit.row(0), fit.row(1) / span, 2 * fit.row(2) / (span * span);
  return out;
}

}  // namespace

Result<SmoothLog> smooth(const JointLog& log, const StopCheck& stop) {
  const std::size_t rows = log.q.size();
  const double length = static_cast<double>(rows) * log.timestep;
  if (rows < 2 || length < kShortest) {
    return fail(Errc::bad_input, text(msg::identification_too_short, rows, length, kShortest));
  }
  const int half = static_cast<int>(std::lround(kHalfWindow / log.timestep));
  if (half < kLeastHalf) {
    return fail(Errc::bad_input,
                text(msg::identification_too_coarse, log.timestep, kHalfWindow / kLeastHalf));
  }
  SmoothLog out{log.timestep, half, {}, {}};
  const Eigen::MatrixXd weights = smoothing_weights(half, log.timestep);
  const Eigen::Index n = log.q.front().size(), count = weights.cols();
  Eigen::MatrixXd q(n, count), torque(n, count);
  for (std::size_t i = 0; i + static_cast<std::size_t>(count) <= rows; ++i) {
    if (is_stopped(stop)) return fail(stopped());
    for (Eigen::Index k = 0; k < count; ++k) {
      q.col(k) = log.q[i + static_cast<std::size_t>(k)];
      torque.col(k) = log.torque[i + static_cast<std::size_t>(k)];
    }
    const Eigen::MatrixXd values = q * weights.transpose();
    out.state.push_back({values.col(0), values.col(1), values.col(2)});
    out.torque.emplace_back(torque * weights.row(0).transpose());
  }
  return out;
}

}  // namespace mjarm::detail
