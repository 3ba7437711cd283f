#include "mjarm/collision/obstacles.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/collision.hpp"

namespace mjarm {
namespace {

constexpr double kLeastSize = 1e-9;  // [m]
constexpr double kMostSize = 1e4;    // [m]

/// Distance of `p`, in the frame of the solid.
struct DistanceTo {
  Eigen::Vector3d p;

  double operator()(const BallShape& ball) const { return std::max(p.norm() - ball.radius, 0.0); }
  double operator()(const CapsuleShape& capsule) const {
    const double beyond = std::max(std::abs(p.z()) - capsule.half_length, 0.0);
    return std::max(std::hypot(p.x(), p.y(), beyond) - capsule.radius, 0.0);
  }
  double operator()(const BoxShape& box) const {
    return (p.cwiseAbs() - box.half).cwiseMax(0.0).norm();
  }
  double operator()(const CylinderShape& cylinder) const {
    const double side = std::max(std::hypot(p.x(), p.y()) - cylinder.radius, 0.0);
    const double beyond = std::max(std::abs(p.z()) - cylinder.half_length, 0.0);
    return std::hypot(side, beyond);
  }
  double operator()(const HalfSpaceShape&) const { return std::max(p.z(), 0.0); }
};

bool size_fits(double size) { return size >= kLeastSize && size <= kMostSize; }

struct SizesFit {
  bool operator()(const BallShape& ball) const { return size_fits(ball.radius); }
  bool operator()(const CapsuleShape& capsule) const {
    return size_fits(capsule.radius) && capsule.half_length >= 0 &&
           capsule.half_length <= kMostSize;
  }
  bool operator()(const BoxShape& box) const {
    return size_fits(box.half.x()) && size_fits(box.half.y()) && size_fits(box.half.z());
  }
  bool operator()(const CylinderShape& cylinder) const {
    return size_fits(cylinder.radius) && size_fits(cylinder.half_length);
  }
  bool operator()(const HalfSpaceShape&) const { return true; }
};

bool is_rotation(const Eigen::Matrix3d& R) {
  return R.allFinite() && (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
         R.determinant() > 0;
}

}  // namespace

double distance(const Obstacle& obstacle, const Eigen::Vector3d& p_W) noexcept {
  const Eigen::Vector3d p_O = obstacle.X_WO.R.transpose() * (p_W - obstacle.X_WO.p);
  return std::visit(DistanceTo{p_O}, obstacle.shape);
}

Result<void> check_obstacles(const Obstacles& obstacles) {
  const std::vector<Obstacle>& solids = obstacles.solids;
  if (solids.size() > kMostObstacles) {
    return fail(Errc::bad_input,
                text(msg::collision_many_obstacles, solids.size(), kMostObstacles));
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Obstacle& obstacle = solids[i];
    const Pose& X = obstacle.X_WO;
    if (!X.p.allFinite() || X.p.cwiseAbs().maxCoeff() > kMostSize) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_place, i, obstacle.name));
    }
    if (!is_rotation(X.R)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_turn, i, obstacle.name));
    }
    if (!std::visit(SizesFit{}, obstacle.shape)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_size, i, obstacle.name));
    }
  }
  return {};
}

}  // namespace mjarm
