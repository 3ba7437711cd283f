#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Numbers of an inertial parameter of a body: Inertial::vector().
inline constexpr int kInertialSize = 10;

/// Parameters of an arm: Inertial::vector() of each link, then the rotor inertia of each joint.
[[nodiscard]] inline int parameter_count(const Arm& arm) { return (kInertialSize + 1) * arm.dof(); }

/// Name of parameter `i`, < parameter_count(): "mx wrist_1_joint", "rotor wrist_1_joint".
[[nodiscard]] std::string parameter_name(int i, const Arm& arm);

/// Joint torques of an arm as linear in the inertial parameters of its links and of what hangs at
/// its tool, by the recursive Newton-Euler equations (W. Khalil, E. Dombre, Modeling,
/// Identification and Control of Robots, 2002, ch. 12). Damping and friction are no part of it.
struct Regressor {
  Eigen::MatrixXd links;    ///< (dof, parameter_count()), each link in its joint's frame
  Eigen::MatrixXd payload;  ///< (dof, 10) of a body in the frame of the tool
};

/// The regressor at one state.
/// @param gravity  [m/s^2] in the world, gravity_of().
[[nodiscard]] Regressor regressor_at(const Arm& arm, const Eigen::Vector3d& gravity,
                                     const JointState& state);

/// Which inertial parameters of an arm's links torques tell at all: columns of Regressor::links
/// that do not depend on earlier ones, and how the others count towards them. An arm of six turning
/// joints that stands upright has 36 of 60, and rotor inertias of the outer joints.
struct BaseColumns {
  std::vector<int> kept;    ///< ascending
  std::vector<int> merged;  ///< all other columns
  /// (kept, merged): column merged[k] = sum over i of kept[i] * weight(i, k), so that base
  /// parameter i is phi[kept[i]] + sum over k of weight(i, k) phi[merged[k]].
  Eigen::MatrixXd weight;

  /// (kept,) The base parameters of links with parameters `phi` (parameter_count(),).
  [[nodiscard]] Eigen::VectorXd of(const Eigen::VectorXd& phi) const;
};
/// Parameters of the model, (parameter_count(),): link_inertials() and armatures.
[[nodiscard]] Eigen::VectorXd parameters_of(const Model& model, const Arm& arm);
/// From random states (M. Gautier, J. Robotic Systems 8 (1991) 485): Gram-Schmidt, base to tip.
[[nodiscard]] BaseColumns base_columns(const Arm& arm, const Eigen::Vector3d& gravity);

}  // namespace mjarm
