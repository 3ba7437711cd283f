#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "mjarm/model/model.hpp"

namespace mjarm {

/// Rigid-body dynamics of a whole model, in MuJoCo's order of qpos (nq,) and qvel (nv,), without
/// contacts, limits and actuators. Owns its scratch memory: one a thread. References that are
/// returned stay valid until the next call.
class Dynamics {
 public:
  explicit Dynamics(const Model& model);
  ~Dynamics();
  Dynamics(Dynamics&&) noexcept;
  Dynamics& operator=(Dynamics&&) noexcept;

  /// Joint-space inertia, nv x nv, with armature on the diagonal [kg m^2].
  const Eigen::MatrixXd& mass_matrix(std::span<const double> qpos);
  /// Torque that holds the model still against gravity, (nv,) [N m].
  const Eigen::VectorXd& gravity(std::span<const double> qpos);
  /// Gravity + Coriolis + centrifugal torque, (nv,) [N m].
  const Eigen::VectorXd& bias(std::span<const double> qpos, std::span<const double> qvel);
  /// Forces the model adds by itself (damping, springs, gravity compensation, that of actuators
  /// included), (nv,) [N m].
  const Eigen::VectorXd& passive(std::span<const double> qpos, std::span<const double> qvel);
  /// M qacc + bias, (nv,) [N m]; no damping, friction, contact.
  const Eigen::VectorXd& inverse(std::span<const double> qpos, std::span<const double> qvel,
                                 std::span<const double> qacc);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
