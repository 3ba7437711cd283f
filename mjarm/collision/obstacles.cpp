#include "mjarm/collision/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

bool place_fits(const Eigen::Vector3d& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() <= kMostSize;
}

Result<void> check_clouds(const std::vector<PointCloud>& clouds) {
  std::size_t points = 0;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const PointCloud& cloud = clouds[i];
    points += cloud.points_W.size();
    if (points > kMostPoints) {
      return fail(Errc::bad_input, text(msg::collision_many_points, i, cloud.name, kMostPoints));
    }
    if (!size_fits(cloud.radius)) {
      return fail(Errc::bad_input, text(msg::collision_cloud_radius, i, cloud.name));
    }
    const auto bad = std::find_if_not(cloud.points_W.begin(), cloud.points_W.end(), place_fits);
    if (bad != cloud.points_W.end()) {
      return fail(Errc::bad_input,
                  text(msg::collision_cloud_point, i, cloud.name, bad - cloud.points_W.begin()));
    }
  }
  return {};
}

}  // namespace

double distance(const Obstacle& obstacle, const Eigen::Vector3d& p_W) noexcept {
  const Eigen::Vector3d p_O = obstacle.X_WO.R.transpose() * (p_W - obstacle.X_WO.p);
  return std::visit(DistanceTo{p_O}, obstacle.shape);
}

double distance(const PointCloud& cloud, const Eigen::Vector3d& p_W) noexcept {
  double least2 = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : cloud.points_W) {
    least2 = std::min(least2, (point - p_W).squaredNorm());
  }
  return std::max(std::sqrt(least2) - cloud.radius, 0.0);
}

const std::string& obstacle_name(const Obstacles& obstacles, int index) noexcept {
  const auto i = static_cast<std::size_t>(index);
  const std::size_t solids = obstacles.solids.size();
  return i < solids ? obstacles.solids[i].name : obstacles.clouds[i - solids].name;
}

Result<void> check_obstacles(const Obstacles& obstacles) {
  const std::vector<Obstacle>& solids = obstacles.solids;
  const std::size_t count = solids.size() + obstacles.clouds.size();
  if (count > kMostObstacles) {
    return fail(Errc::bad_input, text(msg::collision_many_obstacles, count, kMostObstacles));
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Obstacle& obstacle = solids[i];
    const Pose& X = obstacle.X_WO;
    if (!place_fits(X.p)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_place, i, obstacle.name));
    }
    if (!is_rotation(X.R)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_turn, i, obstacle.name));
    }
    if (!std::visit(SizesFit{}, obstacle.shape)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_size, i, obstacle.name));
    }
  }
  return check_clouds(obstacles.clouds);
}

}  // namespace mjarm
