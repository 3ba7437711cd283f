#include "mjarm/control/regressor.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/link_inertials.hpp"

namespace mjarm {
namespace {

using Vec3 = Eigen::Vector3d;
using Wrenches = Eigen::Matrix<double, 6, kInertialSize>;

/// Motion of a frame in the world; `a` is the acceleration of its origin less gravity.
struct FrameMotion {
  Vec3 omega, alpha, a;

  /// Of a point of the same body, `r` from the origin.
  [[nodiscard]] FrameMotion at(const Vec3& r) const {
    return {omega, alpha, a + alpha.cross(r) + omega.cross(omega.cross(r))};
  }
};

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

/// L with L (Ixx, Iyy, Izz, Ixy, Ixz, Iyz) = I w.
Eigen::Matrix<double, 3, 6> inertia_times(const Vec3& w) {
  Eigen::Matrix<double, 3, 6> L;
  L << w.x(), 0, 0, w.y(), w.z(), 0,  //
      0, w.y(), 0, w.x(), 0, w.z(),   //
      0, 0, w.z(), 0, w.x(), w.y();
  return L;
}

/// Force (first three rows) and moment about the origin that a body in the frame (R, motion) needs,
/// in the world, as linear in its parameters.
Wrenches wrenches(const Eigen::Matrix3d& R, const FrameMotion& motion) {
  const Vec3 omega = R.transpose() * motion.omega, alpha = R.transpose() * motion.alpha,
             a = R.transpose() * motion.a;
  const Eigen::Matrix3d turn = cross_matrix(omega);
  Wrenches out = Wrenches::Zero();
  out.block<3, 1>(0, 0) = a;
  out.block<3, 3>(0, 1) = cross_matrix(alpha) + turn * turn;
  out.block<3, 3>(3, 1) = -cross_matrix(a);
  out.block<3, 6>(3, 4) = inertia_times(alpha) + turn * inertia_times(omega);
  out.topRows<3>() = R * out.topRows<3>();
  out.bottomRows<3>() = R * out.bottomRows<3>();
  return out;
}

}  // namespace

std::string parameter_name(int i, const Arm& arm) {
  // As Inertial::vector() has them.
  constexpr std::array<const char*, kInertialSize> kNames{"m",   "mx",  "my",  "mz",  "Ixx",
                                                          "Iyy", "Izz", "Ixy", "Ixz", "Iyz"};
  const int links = kInertialSize * arm.dof();
  if (i >= links) return "rotor " + arm.joints[static_cast<std::size_t>(i - links)].name;
  return std::string(kNames[static_cast<std::size_t>(i % kInertialSize)]) + " " +
         arm.joints[static_cast<std::size_t>(i / kInertialSize)].name;
}

Regressor regressor_at(const Arm& arm, const Vec3& gravity, const JointState& state) {
  const int n = arm.dof();
  std::vector<Pose> X(static_cast<std::size_t>(n));
  const Pose X_WT = fk_all(arm, as_span(state.q), X);
  Regressor out{Eigen::MatrixXd::Zero(n, parameter_count(arm)),
                Eigen::MatrixXd::Zero(n, kInertialSize)};
  // Of a wrench at p each joint inward of it bears its part.
  const auto put = [&](const Wrenches& wrench, const Vec3& p, int last, Eigen::MatrixXd& to,
                       int column) {
    for (int j = 0; j <= last; ++j) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
      const Pose& frame = X[static_cast<std::size_t>(j)];
      const Vec3 z = frame.R * joint.axis;
      const bool turns = joint.type == JointType::hinge;
      const Vec3 lever = turns ? Vec3(z.cross(p - frame.p)) : z;
      Eigen::RowVectorXd row = lever.transpose() * wrench.topRows<3>();
      if (turns) row += z.transpose() * wrench.bottomRows<3>();
      to.block(j, column, 1, kInertialSize) = row;
    }
  };
  FrameMotion motion{Vec3::Zero(), Vec3::Zero(), -gravity};
  Vec3 origin = Vec3::Zero();
  for (int i = 0; i < n; ++i) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    const Pose& frame = X[static_cast<std::size_t>(i)];
    const Vec3 z = frame.R * joint.axis, before = motion.omega;
    motion = motion.at(frame.p - origin);
    if (joint.type == JointType::hinge) {
      motion.omega += z * state.v[i];
      motion.alpha += z * state.a[i] + before.cross(z) * state.v[i];
    } else {
      motion.a += z * state.a[i] + 2 * before.cross(z) * state.v[i];
    }
    origin = frame.p;
    put(wrenches(frame.R, motion), origin, i, out.links, kInertialSize * i);
  }
  out.links.rightCols(n).diagonal() = state.a;
  put(wrenches(X_WT.R, motion.at(X_WT.p - origin)), X_WT.p, n - 1, out.payload, 0);
  return out;
}

Eigen::VectorXd parameters_of(const Model& model, const Arm& arm) {
  Eigen::VectorXd out(parameter_count(arm));
  const std::vector<Inertial> links = link_inertials(model, arm);
  for (int i = 0; i < arm.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.segment<kInertialSize>(kInertialSize * i) = links[k].vector();
    out[kInertialSize * arm.dof() + i] = arm.joints[k].armature;
  }
  return out;
}

Eigen::VectorXd BaseColumns::of(const Eigen::VectorXd& phi) const {
  return phi(kept) + weight * phi(merged);
}

BaseColumns base_columns(const Arm& arm, const Vec3& gravity) {
  constexpr int kStates = 60;
  constexpr double kDependent = 1e-6;  // of the longest column
  const int n = arm.dof(), columns = parameter_count(arm);
  Eigen::MatrixXd W(kStates * n, columns);
  Rng rng(1);
  for (int i = 0; i < kStates; ++i) {
    JointState state = JointState::at_rest(arm.home);
    for (int j = 0; j < n; ++j) {
      state.q[j] += rng.normal();
      state.v[j] = rng.normal();
      state.a[j] = 3 * rng.normal();
    }
    W.middleRows(i * n, n) = regressor_at(arm, gravity, state).links;
  }
  const double least = kDependent * W.colwise().norm().maxCoeff();
  BaseColumns out;
  Eigen::MatrixXd Q(W.rows(), 0);
  for (int k = 0; k < columns; ++k) {
    Eigen::VectorXd rest = W.col(k);
    for (int twice = 0; twice < 2; ++twice) rest -= Q * (Q.transpose() * rest);
    if (rest.norm() <= least) {
      out.merged.push_back(k);
      continue;
    }
    Q.conservativeResize(Eigen::NoChange, Q.cols() + 1);
    Q.rightCols<1>() = rest.normalized();
    out.kept.push_back(k);
  }
  const Eigen::MatrixXd kept = W(Eigen::all, out.kept);
  out.weight =
      solve_symmetric(kept.transpose() * kept, kept.transpose() * W(Eigen::all, out.merged));
  constexpr double kNothing = 1e-6;
  out.weight = (out.weight.array().abs() < kNothing).select(0.0, out.weight);
  return out;
}

}  // namespace mjarm
