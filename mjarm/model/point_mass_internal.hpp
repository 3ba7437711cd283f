#pragma once

#include <Eigen/Core>

struct mjModel_;

namespace mjarm::detail {

/// Adds a point mass [kg] to a body, at `p_B` [m] in its frame, and what MuJoCo derives from it.
void add_point_mass(mjModel_& m, int body, const Eigen::Vector3d& p_B, double mass);

}  // namespace mjarm::detail
