#include <algorithm>
#include <cmath>

#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/branch_choice_internal.hpp"
#include "mjarm/kinematics/trig_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kAtLimit = 1e-6;    // [rad] so little beyond a limit is rounding: the joint is put
                                     // on it and the tool's error tells
constexpr double kNearLimit = 0.02;  // [rad] likewise for forms with a defect, which grows where
                                     // branches meet: Newton's steps tell
constexpr double kNoDefect = 1e-11;  // [rad and m] less is rounding
constexpr double kExact = 1e-10;     // [m and rad] larger errors are polished away

/// The winding of `q` nearest to `q_near` and within the limits, or nearest to their middle where
/// none is within.
double wind(const Chain& chain, int i, double q, double q_near) noexcept {
  const auto k = static_cast<std::size_t>(i);
  const double lower = chain.lower[k];
  const double upper = chain.upper[k];
  if (chain.full_turn[k]) {
    q += kFullTurn * nearest_whole((q_near - q) * (1 / kFullTurn));
    if (q > upper) q -= kFullTurn;
    if (q < lower) q += kFullTurn;
    // A range of exactly one revolution leaves a rounding error at its ends.
    return std::min(std::max(q, lower), upper);
  }
  const double middle = 0.5 * (lower + upper);
  return q + kFullTurn * nearest_whole((middle - q) * (1 / kFullTurn));
}

/// Angle of R^T R_goal [rad].
double angle_between_frames(const Eigen::Matrix3d& R, const Eigen::Matrix3d& R_goal) noexcept {
  const Eigen::Vector3d v = 0.5 * (R.col(0).cross(R_goal.col(0)) + R.col(1).cross(R_goal.col(1)) +
                                   R.col(2).cross(R_goal.col(2)));
  return arc_tangent(v.norm(), 0.5 * (R.cwiseProduct(R_goal).sum() - 1));
}

}  // namespace

Nearness nearness(const double* q, const double* q_near, int dof) noexcept {
  Nearness out;
  for (int i = 0; i < dof; ++i) {
    const double d = std::abs(q[i] - q_near[i]);
    out.largest = std::max(out.largest, d);
    out.sum += d;
  }
  return out;
}

BranchChoice::BranchChoice(const IkSolver& ik, const IkGoal& goal) noexcept
    : ik_(ik), chain_(ik.chain()), options_(ik.options()), goal_(goal) {
  const bool exact = !ik.six_axis() || ik.six_axis()->defect() < kNoDefect;
  beyond_ = exact ? kAtLimit : kNearLimit;
}

BranchChoice::Placed BranchChoice::place(const double* row, double bound) const noexcept {
  Placed out;
  for (int i = 0; i < chain_.dof; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double q = wind(chain_, i, row[i], goal_.seed[i]);
    const double beyond = std::max(chain_.lower[k] - q, q - chain_.upper[k]);
    if (beyond > out.beyond) {
      out.beyond = beyond;
      out.joint = i;
    }
    out.q[i] = beyond > 0 ? std::min(std::max(q, chain_.lower[k]), chain_.upper[k]) : q;
    const double distance = std::abs(out.q[i] - goal_.seed[i]);
    out.near.largest = std::max(out.near.largest, distance);
    out.near.sum += distance;
    if (distance > bound) {
      out.whole = false;
      break;
    }
  }
  return out;
}

IkSolution BranchChoice::measure(const double* q) const noexcept {
  IkSolution out;
  out.q = Eigen::Map<const Eigen::VectorXd>(q, chain_.dof);
  const Pose X_WT = fk(ik_.links(), as_span(out.q));
  out.pos_err = (X_WT.p - goal_.X_WT.p).norm();
  out.rot_err = angle_between_frames(X_WT.R, goal_.X_WT.R);
  return out;
}

std::optional<IkSolution> BranchChoice::confirm(const double* row) const noexcept {
  const Placed placed = place(row);
  if (placed.beyond > beyond_) return std::nullopt;
  IkSolution met = measure(placed.q);
  if (met.pos_err <= kExact && met.rot_err <= kExact) return met;
  DescentOptions careful = descent_options(options_, ik_.length());
  careful.share = placed.beyond > 0;
  const Descent polished = descend(chain_, goal_.X_WT, met.q, careful);
  if (!polished.converged) return std::nullopt;
  return IkSolution{unwind(chain_, polished.q, goal_.seed), polished.pos_err, polished.rot_err,
                    polished.iterations, 0};
}

std::optional<IkSolution> BranchChoice::nearest(const Branches& branches) noexcept {
  Nearness keys[Branches::kCapacity];
  bool open[Branches::kCapacity], whole[Branches::kCapacity];
  double best = kNoBound;
  const auto rank = [&](int i, double bound) {
    const Placed placed = place(branches.q[i], bound);
    keys[i] = placed.near;
    whole[i] = placed.whole;
    open[i] = !placed.whole || placed.beyond <= beyond_;
    if (open[i]) best = std::min(best, placed.near.largest);
  };
  for (int i = 0; i < branches.count; ++i) rank(i, best);
  for (;;) {
    int next = -1;
    for (int i = 0; i < branches.count; ++i) {
      if (open[i] && (next < 0 || keys[i] < keys[next])) next = i;
    }
    if (next < 0) return std::nullopt;
    if (!whole[next]) {
      rank(next, kNoBound);
      continue;
    }
    open[next] = false;
    std::optional<IkSolution> solution = confirm(branches.q[next]);
    if (!solution) continue;
    if (!is_near(*solution)) {
      if (!too_far_) too_far_ = solution;
    } else if (is_accepted(solution->q)) {
      return solution;
    } else if (!refused_) {
      refused_ = solution;
    }
  }
}

IkFailure BranchChoice::failure(const Branches& branches) noexcept {
  IkFailure out;
  if (refused_ || too_far_) {
    out.code = refused_ ? IkErrc::collision : IkErrc::too_far;
    out.best = refused_ ? *refused_ : *too_far_;
    if (refused_) return out;
    Eigen::Index joint = 0;
    out.amount = (out.best.q - goal_.seed).cwiseAbs().maxCoeff(&joint) - options_.max_step;
    out.joint = static_cast<int>(joint);
    return out;
  }
  out.amount = std::numeric_limits<double>::infinity();
  for (int i = 0; i < branches.count; ++i) {
    const Placed placed = place(branches.q[i]);
    if (placed.beyond <= kAtLimit || placed.beyond >= out.amount) continue;
    out.code = IkErrc::joint_limit;
    out.joint = placed.joint;
    out.amount = placed.beyond;
    out.best = measure(placed.q);
  }
  if (out.code == IkErrc::joint_limit) return out;
  out.amount = 0;
  if (!branches.has_best) {
    out.best = measure(goal_.seed.data());
    return out;
  }
  out.code = branches.why;
  out.shape = branches.shape;
  if (out.code != IkErrc::no_convergence) out.amount = branches.amount;
  out.bound = branches.bound;
  out.best = measure(place(branches.best).q);
  return out;
}

}  // namespace mjarm::detail
