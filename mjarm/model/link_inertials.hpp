#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// The ten inertial parameters of a rigid body in a frame F: what joint torques are linear in.
struct Inertial {
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   ///< [kg m] mass times centre of mass, in F
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< [kg m^2] about the origin of F, in F

  /// (10,) mass, mx, my, mz, Ixx, Iyy, Izz, Ixy, Ixz, Iyz.
  [[nodiscard]] Eigen::Matrix<double, 10, 1> vector() const {
    Eigen::Matrix<double, 10, 1> out;
    out << mass, moment, inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2),
        inertia(1, 2);
    return out;
  }
};

/// [kg m^2] Inertia of a point mass [kg] at `p` [m], about the origin.
[[nodiscard]] inline Eigen::Matrix3d point_inertia(double mass, const Eigen::Vector3d& p) {
  return mass * (p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose());
}

/// What each joint of the arm moves and the next one does not, in the frame J of that joint: all
/// moved_bodies() there together.
[[nodiscard]] std::vector<Inertial> link_inertials(const Model& model, const Arm& arm);

}  // namespace mjarm
