#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/planning/sampler_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kEndless = 4 * std::numbers::pi;  // [rad or m] stands for no limit
constexpr double kFirstMargin = 0.5;               // [rad or m] of the box at first
constexpr double kWidening = 0.01;                 // [rad or m] a sample
constexpr double kNearest = 0.2, kFarthest = 2;    // [rad or m] of what is drawn beside a node

}  // namespace

WideningBox::WideningBox(const SearchProblem& problem, Rng& rng)
    : halton_(problem.start.size(), rng) {
  const JointLimits& limits = problem.checker.robot().arm().limits;
  for (std::size_t k = 0; k < problem.start.size(); ++k) {
    const auto joint = static_cast<Eigen::Index>(k);
    least_[k] = std::max(limits.lower[joint], -kEndless);
    max_[k] = std::min(limits.upper[joint], kEndless);
    low_[k] = high_[k] = problem.start[k];
    for (const std::span<const double> goal : problem.goals) {
      low_[k] = std::min(low_[k], goal[k]);
      high_[k] = std::max(high_[k], goal[k]);
    }
  }
}

void WideningBox::next(std::span<double> q) {
  std::array<double, kMaxDof> unit;
  halton_.next(unit.data());
  const double margin = kFirstMargin + kWidening * count_++;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double low = std::max(low_[k] - margin, least_[k]);
    const double high = std::min(high_[k] + margin, max_[k]);
    q[k] = low + unit[k] * (high - low);
  }
}

double draw_beside(std::span<const double> from, Rng& rng, std::span<double> q) {
  const double length = kNearest * std::pow(kFarthest / kNearest, rng.uniform());
  double norm2 = 0;
  for (double& x : q) {
    x = rng.normal();
    norm2 += x * x;
  }
  const double scale = length / std::sqrt(std::max(norm2, 1e-12));
  for (std::size_t k = 0; k < q.size(); ++k) q[k] = from[k] + scale * q[k];
  return length;
}

}  // namespace mjarm::detail
