#pragma once

#include <Eigen/Core>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Range of a distance [m].
struct DistanceRange {
  double low = 0;
  double high = 0;
};

/// One hinge of an arm at its reference configuration (hinges at 0, slides in mid-travel).
struct HingeAxis {
  Eigen::Vector3d p_W;      ///< [m] a point of the axis
  Eigen::Vector3d a_W;      ///< unit direction
  double lower = 0;         ///< [rad]
  double upper = 0;         ///< [rad]
  double slack_before = 0;  ///< [m] half travel of the slides between the hinge before and this one
};

/// The hinge axes of an arm as lines in the world at its reference configuration. Distances between
/// points of neighbouring axes are those of every configuration, but for the slides' travel.
struct AxisChain {
  explicit AxisChain(const Arm& arm);

  std::vector<HingeAxis> axes;
  double slack_after = 0;  ///< [m] half travel of the slides after the last hinge
  double slack = 0;        ///< [m] half travel of all slides, inf for an endless one
  Pose X_WT;               ///< the tool at the reference configuration
};

/// Points, one on each of the axes first..last (inclusive), whose polyline is shortest.
[[nodiscard]] std::vector<Eigen::Vector3d> shortest_polyline(const AxisChain& chain, int first,
                                                             int last);

/// Range of |u - R(a, angle) v| for angle in [lower, upper] [rad], a unit.
[[nodiscard]] DistanceRange distance_across(const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                                            const Eigen::Vector3d& a, double lower, double upper);

}  // namespace mjarm
