#include "mjarm/kinematics/posture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/kinematics/bend_internal.hpp"

namespace mjarm {
namespace {

IkOptions geometry_alone(IkOptions options) {
  options.valid = {};
  return options;
}

}  // namespace

PostureCost::PostureCost(const IkSolver& ik, PostureWeights weights)
    : ik_(ik.with(geometry_alone(ik.options()))), weights_(weights) {}

/// 0 where every joint is in the middle of its range, 1 where each is at a limit.
double PostureCost::off_middle(std::span<const double> q) const noexcept {
  const JointLimits& limits = ik_.arm().limits;
  double sum = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double half = 0.5 * (limits.upper[k] - limits.lower[k]);
    if (!(half > 0) || !std::isfinite(half)) continue;
    const double off = (q[i] - 0.5 * (limits.upper[k] + limits.lower[k])) / half;
    sum += off * off;
  }
  return q.empty() ? 0 : sum / static_cast<double>(q.size());
}

double PostureCost::at(std::span<const double> q, double clearance) const noexcept {
  constexpr double kStraight = 1e-3;  // [m] an elbow no farther aside is neither up nor down
  const double left = std::clamp(clearance / weights_.enough_clearance, 0.0, 1.0);
  double cost = weights_.clearance * (1 - left) + weights_.middle * off_middle(q);
  const detail::Bend bend = detail::bend_of(ik_, q);
  if (!bend.has_elbow) return cost;
  const double size = bend.aside.norm();
  const double up = size > kStraight ? bend.aside.z() / size : 0;
  return cost + weights_.elbow * 0.5 * (1 - up);
}

double PostureCost::travel(const JointVec& q, const JointVec& q_near) const noexcept {
  double most = 0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const bool slide = ik_.chain().slide[static_cast<std::size_t>(i)];
    most = std::max(most, std::abs(q[i] - q_near[i]) / (slide ? 1 : std::numbers::pi));
  }
  return weights_.travel * most;
}

std::vector<double> sort_by_posture(const PostureCost& cost, std::vector<JointVec>& answers,
                                    std::span<const double> q_near,
                                    const ClearanceMeasure& clearance) {
  const JointVec near = joint_vec(q_near);
  std::vector<std::pair<double, JointVec>> weighed;
  weighed.reserve(answers.size());
  for (const JointVec& q : answers) {
    const double room = clearance ? clearance(as_span(q)) : PostureCost::kFar;
    weighed.emplace_back(cost.at(as_span(q), room) + cost.travel(q, near), q);
  }
  std::ranges::stable_sort(weighed, {}, &std::pair<double, JointVec>::first);
  std::vector<double> costs;
  for (std::size_t i = 0; i < weighed.size(); ++i) {
    costs.push_back(weighed[i].first);
    answers[i] = std::move(weighed[i].second);
  }
  return costs;
}

}  // namespace mjarm
