#pragma once

#include <Eigen/Core>
#include <cassert>
#include <span>

namespace mjarm {

/// Most joints an arm may have; vectors of joint values up to this size never allocate.
inline constexpr int kMaxDof = 16;

/// One number per joint, shape (dof,), dof <= kMaxDof; inline storage (no heap).
/// Units are those of the quantity: rad or m, rad/s or m/s, N m or N.
using JointVec = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxDof, 1>;

/// Geometric Jacobian, 6 x dof: rows 0-2 linear [m/rad], rows 3-5 angular [rad/rad].
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxDof>;

/// Copies `values` (at most kMaxDof) into a JointVec.
[[nodiscard]] inline JointVec joint_vec(std::span<const double> values) {
  assert(values.size() <= static_cast<std::size_t>(kMaxDof));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Views a JointVec as a span, so that it passes where plain memory is taken.
[[nodiscard]] inline std::span<const double> as_span(const JointVec& q) {
  return {q.data(), static_cast<std::size_t>(q.size())};
}

}  // namespace mjarm
