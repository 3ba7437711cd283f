#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/planning/sampler_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kEndless = 4 * std::numbers::pi;  // [rad or m] stands for no limit
constexpr double kFirstMargin = 0.5;               // [rad or m] of the box round the ends at first
constexpr double kFirstBeside = 0.7, kMaxBeside = 2;  // [rad or m] half the box round a node
constexpr double kWidening = 0.01;                    // [rad or m] of both, a sample

}  // namespace

Sampler::Sampler(const SearchProblem& problem, Rng& rng)
    : rng_(rng), halton_(problem.start.size(), rng) {
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

void Sampler::between_ends(std::span<double> q) {
  std::array<double, kMaxDof> unit;
  halton_.next(unit.data());
  const double margin = kFirstMargin + kWidening * count_++;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double low = std::max(low_[k] - margin, least_[k]);
    const double high = std::min(high_[k] + margin, max_[k]);
    q[k] = low + unit[k] * (high - low);
  }
}

void Sampler::beside(std::span<const double> node, std::span<double> q) {
  const double widest = std::min(kFirstBeside + kWidening * count_++, kMaxBeside);
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double half = std::min(widest, 0.5 * (max_[k] - least_[k]));
    q[k] = std::clamp(node[k] + rng_.uniform(-half, half), least_[k], max_[k]);
  }
}

}  // namespace mjarm::detail
