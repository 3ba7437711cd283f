#include "mjarm/planning/tilt_limit.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
bool is_sound(const TiltLimit& limit) noexcept {
  const auto is_unit = [](const Eigen::Vector3d& v) { return std::abs(v.norm() - 1) < 1e-9; };
  return limit.max >= kLeastTilt && limit.max < std::numbers::pi / 2 && is_unit(limit.axis_T) &&
         is_unit(limit.axis_W);
}

TiltLimit keep_upright(const Arm& arm, std::span<const double> q, double max) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  return {max, (fk(arm, q).R.transpose() * up).normalized(), up};
}

double tilt(const TiltLimit& limit, const Arm& arm, std::span<const double> q) {
  const Eigen::Vector3d u = fk(arm, q).R * limit.axis_T;
  return std::atan2(u.cross(limit.axis_W).norm(), u.dot(limit.axis_W));
}

TaskRegion as_region(const TiltLimit& limit) {
  const auto with_z = [](const Eigen::Vector3d& z) {
    return rotation_between(Eigen::Vector3d::UnitZ(), z);
  };
  TaskRegion out = region_about({}, Eigen::Vector3d::Constant(kFreePlace), limit.max, kFreeTurn);
  out.X_WR.R = with_z(limit.axis_W);
  out.X_FT.R = with_z(limit.axis_T).transpose();
  return out;
}

}  // namespace mjarm
