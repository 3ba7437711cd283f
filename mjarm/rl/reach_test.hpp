#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/rl/reach_env.hpp"

namespace mjarm::testing {

using namespace rl;

inline Model task_model(const ReachOptions& options = {}) {
  auto model = reach_model(options);
  if (!model) throw std::runtime_error(model.error().what);
  return std::move(*model);
}

inline ReachEnv reach_env(const ReachOptions& options = {}) {
  auto env = ReachEnv::create(task_model(options), options);
  if (!env) throw std::runtime_error(env.error().what);
  return std::move(*env);
}

/// Row `i` of a matrix with `columns` numbers a row.
template <class Number>
std::span<Number> row(std::span<Number> matrix, int i, int columns) {
  return matrix.subspan(static_cast<std::size_t>(i) * columns, columns);
}

/// Actions of a copy that depend on its number and the step alone.
inline void random_actions(std::span<float> actions, int copy, int step) {
  Rng rng(static_cast<std::uint64_t>(step), static_cast<std::uint64_t>(copy));
  for (float& a : actions) a = static_cast<float>(rng.uniform(-1.2, 1.2));
}

/// One step of all copies with random_actions.
inline void random_step(ReachEnv& env, int step) {
  std::vector<float> actions(static_cast<std::size_t>(env.count()) * env.action_size());
  for (int i = 0; i < env.count(); ++i) {
    random_actions(row(std::span(actions), i, env.action_size()), i, step);
  }
  const auto stepped = env.step(actions);
  ASSERT_TRUE(stepped) << stepped.error().what;
}

/// Knows how to reach from what a policy sees alone: damped least squares on the error of the tool.
class Expert {
 public:
  Expert(Arm arm, ReachOptions options) : arm_(std::move(arm)), options_(std::move(options)) {}

  /// Joint values, from a row of observations.
  [[nodiscard]] JointVec joints(std::span<const float> seen) const {
    JointVec q(arm_.dof());
    for (int k = 0; k < arm_.dof(); ++k) {
      const double middle = (arm_.limits.lower[k] + arm_.limits.upper[k]) / 2;
      const double half = (arm_.limits.upper[k] - arm_.limits.lower[k]) / 2;
      q[k] = middle + half * seen[k];
    }
    return q;
  }

  void act(std::span<const float> seen, std::span<float> actions) const {
    const int n = arm_.dof();
    const JointVec q = joints(seen);
    const FkJacobian at = fk_jacobian(arm_, as_span(q));
    const auto three = [&](int first) {
      return Eigen::Vector3d(seen[first], seen[first + 1], seen[first + 2]);
    };
    Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
    error.head<3>() = 0.25 * three(2 * n + 12);
    error.head<3>() *= std::min(1.0, 0.03 / std::max(error.head<3>().norm(), 1e-9));
    if (options_.orientation) {
      error.tail<3>() = three(2 * n + 18);
      error.tail<3>() *= std::min(1.0, 0.1 / std::max(error.tail<3>().norm(), 1e-9));
    }
    Eigen::MatrixXd J = at.J_W;
    if (!options_.orientation) J.bottomRows(3).setZero();
    const Eigen::MatrixXd A = J * J.transpose() + 1e-3 * Eigen::MatrixXd::Identity(6, 6);
    const Eigen::MatrixXd inverse = J.transpose() * A.inverse();
    // What the goal leaves free keeps away from the limits.
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(n, n) - inverse * J;
    const Eigen::VectorXd middle = (arm_.limits.lower + arm_.limits.upper) / 2 - q;
    const Eigen::VectorXd dq = inverse * error + 0.02 * rest * middle;
    for (int k = 0; k < n; ++k) {
      const double step = options_.speed * arm_.limits.velocity[k] * 0.002 * options_.frame_skip;
      actions[k] = static_cast<float>(std::clamp(dq[k] / step, -1.0, 1.0));
    }
  }

 private:
  Arm arm_;
  ReachOptions options_;
};

}  // namespace mjarm::testing
