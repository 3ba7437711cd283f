#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A body that the joints of an arm move: a link, a hand, what hangs at the tool.
struct MovedBody {
  int body = -1;                     ///< its number in the model
  int joint = -1;                    ///< index of the last joint of the arm that moves it
  Pose X_JB;                         ///< its frame in the frame of that joint
  double mass = 0;                   ///< [kg] > 0
  Eigen::Vector3d center_J;          ///< [m] centre of mass in the frame of that joint
  Eigen::Matrix3d inertia_center_J;  ///< [kg m^2] about that centre, in the axes of that frame
};

/// All bodies with a mass that `arm` moves, in the order of the model; joints that are not the
/// arm's (fingers) as at home.
[[nodiscard]] std::vector<MovedBody> moved_bodies(const Model& model, const Arm& arm);

/// [m/s^2] of the model, in the world frame.
[[nodiscard]] Eigen::Vector3d gravity_of(const Model& model);

}  // namespace mjarm
