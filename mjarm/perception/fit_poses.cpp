#include <algorithm>
#include <utility>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/perception/fit_poses_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr int kMaxSteps = 50;
constexpr double kEnough = 1e-12;  // a step that gains less of the sum is the last

std::vector<Pose> all_moved(const std::vector<Pose>& poses, const Eigen::VectorXd& by) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    out.push_back(moved(poses[i], by.segment<6>(static_cast<Eigen::Index>(6 * i))));
  }
  return out;
}

Eigen::MatrixXd slopes(const std::vector<Pose>& poses, const Residuals& residuals, Eigen::Index m) {
  constexpr double kStep = 1e-6;  // [m] and [rad]
  const auto n = static_cast<Eigen::Index>(6 * poses.size());
  Eigen::MatrixXd J(m, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(n, k);
    J.col(k) =
        (residuals(all_moved(poses, step)) - residuals(all_moved(poses, -step))) / (2 * kStep);
  }
  return J;
}

}  // namespace

Pose moved(const Pose& X, const Eigen::Ref<const Eigen::Matrix<double, 6, 1>>& by) {
  return {.p = X.p + by.head<3>(), .R = rotation_exp(by.tail<3>()) * X.R};
}

PoseFit fit_poses(std::vector<Pose> start, const Residuals& residuals) {
  PoseFit fit{std::move(start), 0};
  Eigen::VectorXd r = residuals(fit.poses);
  fit.squares = r.squaredNorm();
  double damping = 1e-6;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::MatrixXd J = slopes(fit.poses, residuals, r.size());
    Eigen::MatrixXd H = J.transpose() * J;
    H.diagonal() *= 1 + damping;
    H.diagonal().array() += 1e-12;
    PoseFit next{all_moved(fit.poses, -solve_symmetric(H, J.transpose() * r)), 0};
    const Eigen::VectorXd r_next = residuals(next.poses);
    next.squares = r_next.squaredNorm();
    if (!(next.squares < fit.squares)) {
      damping *= 100;
      if (damping > 1e6) break;
      continue;
    }
    const double gained = fit.squares - next.squares;
    fit = std::move(next);
    r = r_next;
    damping = std::max(damping / 10, 1e-9);
    if (gained <= kEnough * fit.squares) break;
  }
  return fit;
}

}  // namespace mjarm::perception
