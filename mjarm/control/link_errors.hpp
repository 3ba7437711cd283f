#pragma once

#include <Eigen/Core>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/wrong_model.hpp"

namespace mjarm {

/// By how much the torques of a motion may be wrong because masses and centres of mass are: the
/// equation of motion is linear in them (C. Atkeson, C. An, J. Hollerbach, IJRR 5 (1986) 101), so
/// each of them has a torque of its own.
class LinkErrors {
 public:
  LinkErrors(const Model& model, const Arm& arm, const ModelErrors& errors);

  /// Four numbers for each body: its mass and its inertia, and where its centre is along x, y, z.
  [[nodiscard]] Eigen::Index count() const noexcept { return columns_.cols(); }
  /// The change of torque, (dof, count()) [N m or N], that each of these numbers makes at one
  /// standard deviation of ModelErrors (a uniform mass, a centre on a sphere): what has to be given
  /// beside the torque of the model so that the arm moves like this.
  /// @param q, v, a  of the joints, (dof,) [rad or m], over [s], over [s^2].
  [[nodiscard]] Eigen::MatrixXd torques(const JointVec& q, const JointVec& v,
                                        const JointVec& a) const;

 private:
  Arm arm_;
  Eigen::Vector3d gravity_;
  Eigen::MatrixXd columns_;  ///< (10 dof, count()) Inertial::vector() of all links, a number each
};

}  // namespace mjarm
