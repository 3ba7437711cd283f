// Two orientations that are nearly the same, and two ways from one to the other.
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "mjarm/core/rotation.hpp"

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// What the tool turns in all [rad] from t = 0 to 1.
double way(const std::function<Eigen::Matrix3d(double t)>& rotation) {
  double sum = 0;
  for (int i = 0; i < 200; ++i) {
    sum += mjarm::angle_between(rotation(i / 200.0), rotation((i + 1) / 200.0));
  }
  return sum;
}

}  // namespace

int main() {
  const Eigen::Matrix3d fixed = mjarm::from_euler({3.0, 0.4, 1.0});  // about fixed axes x, y, z
  const Eigen::Matrix3d x = mjarm::from_euler({3.0, 0, 0});
  const Eigen::Matrix3d y = mjarm::from_euler({0, 0.4, 0});
  const Eigen::Matrix3d z = mjarm::from_euler({0, 0, 1.0});
  const double same = (fixed - z * y * x).cwiseAbs().maxCoeff();
  std::printf("fixed = Rz Ry Rx to %.0e; the same numbers about moving axes: %.1f deg away\n", same,
              mjarm::angle_between(fixed, x * y * z) / kDegree);
  const mjarm::Quat quat = mjarm::to_quat(fixed);
  const mjarm::Quat swapped(quat.x(), quat.y(), quat.z(), quat.w());
  std::printf("quaternion read in the order x y z w: %.1f deg away\n",
              mjarm::angle_between(fixed, mjarm::to_matrix(swapped)) / kDegree);

  const Eigen::Vector3d start(170 * kDegree, 0, 0);  // tool down, leaning 10 deg to one side
  const Eigen::Vector3d goal(-170 * kDegree, 0, 0);  // and to the other
  const Eigen::Matrix3d from = mjarm::from_euler(start);
  const Eigen::Matrix3d to = mjarm::from_euler(goal);
  std::printf("from one lean to the other: %.1f deg\n", mjarm::angle_between(from, to) / kDegree);
  const auto by_euler = [&](double t) -> Eigen::Matrix3d {
    return mjarm::from_euler(start + t * (goal - start));
  };
  const auto by_slerp = [&](double t) {
    return mjarm::to_matrix(mjarm::slerp(mjarm::to_quat(from), mjarm::to_quat(to), t));
  };
  const double long_way = way(by_euler) / kDegree;
  const double short_way = way(by_slerp) / kDegree;
  std::printf("way by Euler angles %.1f deg, by slerp %.1f deg\n", long_way, short_way);
  std::printf("half way the tool's z axis points: Euler %+.2f, slerp %+.2f   (+1 up, -1 down)\n",
              by_euler(0.5)(2, 2), by_slerp(0.5)(2, 2));
  return same < 1e-15 && long_way > 300 && std::abs(short_way - 20) < 0.01 ? 0 : 1;
}
