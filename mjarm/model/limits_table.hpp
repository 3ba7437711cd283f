#pragma once

#include <span>
#include <string_view>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Limits where neither the model file nor the table of known robots has any. They are careful
/// values for a light arm; acceleration and jerk are never in a model file.
struct StandardLimits {
  double velocity;      ///< [rad/s or m/s]
  double acceleration;  ///< [rad/s^2 or m/s^2]
  double jerk;          ///< [rad/s^3 or m/s^3]
  double torque;        ///< [N m or N]
};

/// Hinge: 2 rad/s, 5 rad/s^2, 100 rad/s^3, 100 N m. Slide: 0.5 m/s, 5 m/s^2, 100 m/s^3, 1000 N.
[[nodiscard]] StandardLimits standard_limits(JointType type) noexcept;

/// Public figures of a robot; every span has one entry a joint.
struct KnownRobot {
  std::string_view name;
  std::span<const double> velocity;      ///< [rad/s]
  std::span<const double> acceleration;  ///< [rad/s^2]
  std::span<const double> jerk;          ///< [rad/s^3]
  std::span<const double> torque;        ///< [N m]
};

/// The known robot with the geometry of `arm`: the distances and angles between neighbouring joint
/// axes agree within 3 mm and 0.01 rad. Needs joints with X_PJ and axis; null where none fits.
[[nodiscard]] const KnownRobot* known_robot(const Arm& arm) noexcept;

}  // namespace mjarm
