#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "mjarm/collision/obstacles.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

/// Random robots and worlds, and an oracle of their clearance: textbook distances in double
/// precision, one sphere and one solid at a time.
namespace mjarm::testing {

inline Eigen::Vector3d random_vector(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// A few spheres on every link of an arm, and one piece at rest.
inline SphereSet random_spheres(const Arm& arm, Rng& rng) {
  SphereSet set;
  for (int joint = -1; joint < arm.dof(); ++joint) {
    LinkSpheres link{"link" + std::to_string(joint + 1), joint, {}};
    const int count = 1 + static_cast<int>(rng.below(5));
    for (int k = 0; k < count; ++k) {
      link.spheres.push_back({random_vector(rng, 0.15), rng.uniform(0.01, 0.08)});
    }
    set.links.push_back(link);
  }
  for (int a = 0; a < static_cast<int>(set.links.size()); ++a) {
    for (int b = a + 2; b < static_cast<int>(set.links.size()); ++b) {
      if (rng.uniform() < 0.3)
        set.pairs.push_back(rng.uniform() < 0.5 ? std::array{a, b} : std::array{b, a});
    }
  }
  return set;
}

/// A solid of any kind, `thin`: plates and wires. Half of them share one of two orientations.
inline Obstacle random_obstacle(Rng& rng, bool thin) {
  Obstacle out;
  out.X_WO.p = random_vector(rng, 1.2);
  const double turn = rng.uniform();
  if (turn < 0.5) out.X_WO.R = from_euler(random_vector(rng, 3));
  if (turn > 0.8) out.X_WO.R = from_euler({0, 0, turn > 0.9 ? 0.4 : std::numbers::pi / 2});
  const double size = thin ? 5e-4 : rng.uniform(0.02, 0.3);
  switch (rng.below(thin ? 2 : 5)) {
    case 0: {
      Eigen::Vector3d half(rng.uniform(0.05, 0.5), rng.uniform(0.05, 0.5), rng.uniform(0.05, 0.5));
      half[static_cast<Eigen::Index>(rng.below(3))] = size;
      out.shape = BoxShape{half};
      break;
    }
    case 1:
      out.shape = CapsuleShape{size, rng.uniform(0.05, 0.6)};
      break;
    case 2:
      out.shape = BallShape{size};
      break;
    case 3:
      out.shape = CylinderShape{size, rng.uniform(0.02, 0.4)};
      break;
    default:
      out.X_WO.p += 1.5 * out.X_WO.p.normalized();
      out.X_WO.R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -out.X_WO.p)
                       .toRotationMatrix();
      out.shape = HalfSpaceShape{};
  }
  return out;
}

inline Obstacles random_world(Rng& rng, int count, bool thin = false) {
  Obstacles out;
  for (int i = 0; i < count; ++i) out.solids.push_back(random_obstacle(rng, thin));
  return out;
}

/// Points on a plane, on a line, in a heap or all in one place.
inline PointCloud random_cloud(Rng& rng, int count, double radius) {
  PointCloud out{"cloud", {}, radius};
  const Eigen::Vector3d middle = random_vector(rng, 0.9);
  const Eigen::Matrix3d R = from_euler(random_vector(rng, 3));
  Eigen::Vector3d half(rng.uniform(0.1, 0.6), rng.uniform(0.1, 0.6), rng.uniform(0.1, 0.6));
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(rng.below(4)); ++k) half[k] = 0;
  for (int i = 0; i < count; ++i) {
    out.points_W.push_back(middle + R * half.cwiseProduct(random_vector(rng, 1)));
  }
  return out;
}

/// From a point to the nearest point of a solid; the point is in its frame.
inline double point_distance(const ObstacleShape& shape, const Eigen::Vector3d& p) {
  if (const auto* ball = std::get_if<BallShape>(&shape)) return p.norm() - ball->radius;
  if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) {
    const double z = std::clamp(p.z(), -capsule->half_length, capsule->half_length);
    return (p - Eigen::Vector3d(0, 0, z)).norm() - capsule->radius;
  }
  if (const auto* box = std::get_if<BoxShape>(&shape)) {
    return (p - p.cwiseMax(-box->half).cwiseMin(box->half)).norm();
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    const double radial = p.head<2>().norm();
    Eigen::Vector3d nearest = p;
    if (radial > cylinder->radius) nearest.head<2>() *= cylinder->radius / radial;
    nearest.z() = std::clamp(p.z(), -cylinder->half_length, cylinder->half_length);
    return (p - nearest).norm();
  }
  return p.z();
}

/// SphereClearance of a configuration; negative where something overlaps. `moving_only`: links at
/// rest are held against other links alone.
inline double true_clearance(const Arm& arm, const SphereSet& set, const Obstacles& world,
                             std::span<const double> q, bool moving_only = false) {
  std::vector<Pose> X_WJ(static_cast<std::size_t>(arm.dof()));
  fk_all(arm, q, X_WJ);
  std::vector<std::vector<Eigen::Vector3d>> centers;
  double least = std::numeric_limits<double>::infinity();
  for (const LinkSpheres& link : set.links) {
    const Pose X = link.joint < 0 ? Pose() : X_WJ[static_cast<std::size_t>(link.joint)];
    centers.emplace_back();
    for (const Sphere& sphere : link.spheres) {
      const Eigen::Vector3d center = X * sphere.center;
      centers.back().push_back(center);
      if (moving_only && link.joint < 0) continue;
      for (const Obstacle& solid : world.solids) {
        const Eigen::Vector3d p = solid.X_WO.inverse() * center;
        least = std::min(least, point_distance(solid.shape, p) - sphere.radius);
      }
      for (const PointCloud& cloud : world.clouds) {
        for (const Eigen::Vector3d& point : cloud.points_W) {
          least = std::min(least, (point - center).norm() - cloud.radius - sphere.radius);
        }
      }
    }
  }
  for (const auto& [a, b] : set.pairs) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < centers[i].size(); ++k) {
      for (std::size_t l = 0; l < centers[j].size(); ++l) {
        const double radii = set.links[i].spheres[k].radius + set.links[j].spheres[l].radius;
        least = std::min(least, (centers[i][k] - centers[j][l]).norm() - radii);
      }
    }
  }
  return least;
}

}  // namespace mjarm::testing
