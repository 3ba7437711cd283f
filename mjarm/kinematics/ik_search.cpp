#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/kinematics/ik_search_internal.hpp"

namespace mjarm::detail {

const char* option_out_of_range(const IkOptions& options) noexcept {
  // Written so that NaN is refused.
  if (!(options.pos_tol > 0)) return "pos_tol";
  if (!(options.rot_tol > 0)) return "rot_tol";
  if (options.max_iterations < 1) return "max_iterations";
  if (options.restarts < 0) return "restarts";
  if (!(options.max_step > 0)) return "max_step";
  return nullptr;
}

bool check_goal(const Chain& chain, const IkOptions& options, const Pose& X_WT,
                std::span<const double> q_seed, IkGoal& goal) noexcept {
  if (chain.dof == 0 || q_seed.size() != static_cast<std::size_t>(chain.dof)) return false;
  if (option_out_of_range(options) != nullptr) return false;
  if (!X_WT.p.allFinite() || !X_WT.R.allFinite()) return false;
  const Eigen::Matrix3d gram = X_WT.R.transpose() * X_WT.R;
  if (!gram.isIdentity(1e-6) || X_WT.R.col(0).cross(X_WT.R.col(1)).dot(X_WT.R.col(2)) < 0) {
    return false;
  }
  // One Newton step to the nearest orthonormal matrix squares the 1e-6.
  goal.X_WT = {X_WT.p, 0.5 * X_WT.R * (3 * Eigen::Matrix3d::Identity() - gram)};
  goal.seed.resize(chain.dof);
  for (int i = 0; i < chain.dof; ++i) {
    const double value = q_seed[static_cast<std::size_t>(i)];
    if (!std::isfinite(value)) return false;
    goal.seed[i] = std::min(std::max(value, chain.lower[i]), chain.upper[i]);
  }
  return true;
}

JointVec random_start(const Chain& chain, const JointVec& seed, Rng& rng) noexcept {
  JointVec q(chain.dof);
  for (int i = 0; i < chain.dof; ++i) {
    const double half = chain.slide[i] ? 1.0 : std::numbers::pi;
    double lower = chain.lower[i];
    double upper = chain.upper[i];
    // Two windings of a hinge are one start, so a revolution is enough.
    if (chain.full_turn[i] || !std::isfinite(upper - lower)) {
      lower = std::max(lower, seed[i] - half);
      upper = std::min(upper, lower + 2 * half);
      lower = std::max(chain.lower[i], upper - 2 * half);
    }
    q[i] = rng.uniform(lower, upper);
  }
  return q;
}

JointVec random_start_at_stops(const Chain& chain, const JointVec& seed, Rng& rng) noexcept {
  constexpr double kShare = 1.0 / 6;  // at each of the two stops
  JointVec q = random_start(chain, seed, rng);
  for (int i = 0; i < chain.dof; ++i) {
    const double side = rng.uniform();
    if (chain.full_turn[i] || !std::isfinite(chain.upper[i] - chain.lower[i])) continue;
    if (side < kShare) q[i] = chain.lower[i];
    if (side > 1 - kShare) q[i] = chain.upper[i];
  }
  return q;
}

DescentOptions descent_options(const IkOptions& options, double length) noexcept {
  DescentOptions out;
  out.pos_tol = options.pos_tol;
  out.rot_tol = options.rot_tol;
  out.max_iterations = options.max_iterations;
  out.length = length;
  out.task = options.task;
  return out;
}

double characteristic_length(const Chain& chain) noexcept {
  double length = chain.X_JT.p.norm();
  for (int i = 1; i < chain.dof; ++i) length += chain.X_PJ[i].p.norm();
  return length > 0 ? 0.5 * length : 1.0;
}

}  // namespace mjarm::detail
