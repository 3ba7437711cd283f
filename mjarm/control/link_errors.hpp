#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/moved_bodies.hpp"
#include "mjarm/model/wrong_model.hpp"

namespace mjarm {

/// By how much the torques of a motion may be wrong because masses and centres of mass are: the
/// equation of motion is linear in them (C. Atkeson, C. An, J. Hollerbach, IJRR 5 (1986) 101), so
/// each of them has a torque of its own. Owns its scratch memory: one a thread.
class LinkErrors {
 public:
  LinkErrors(const Model& model, const Arm& arm, const ModelErrors& errors);

  /// Four numbers for each body: its mass and its inertia, and where its centre is along x, y, z.
  [[nodiscard]] Eigen::Index count() const noexcept {
    return 4 * static_cast<Eigen::Index>(bodies_.size());
  }
  /// The change of torque, (dof, count()) [N m or N], that each of these numbers makes at one
  /// standard deviation of ModelErrors (a uniform mass, a centre on a sphere): what has to be given
  /// beside the torque of the model so that the arm moves like this.
  /// @param q, v, a  of the joints, (dof,) [rad or m], over [s], over [s^2].
  const Eigen::MatrixXd& torques(const JointVec& q, const JointVec& v, const JointVec& a);

 private:
  void move_links(const JointVec& q, const JointVec& v, const JointVec& a);
  void add(Eigen::Index column, int joint, const Eigen::Vector3d& force,
           const Eigen::Vector3d& moment);

  Arm arm_;
  std::vector<MovedBody> bodies_;
  Eigen::Vector3d gravity_;
  double mass_, center_;
  std::vector<Pose> X_WJ_;
  std::vector<Eigen::Vector3d> axis_, turn_, turning_, rise_;  ///< of each link, in the world
  Eigen::MatrixXd torques_;
};

}  // namespace mjarm
