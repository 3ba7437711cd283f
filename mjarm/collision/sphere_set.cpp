#include "mjarm/collision/sphere_set.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/collision.hpp"

namespace mjarm {
namespace {

constexpr double kLeastRadius = 1e-6;  // [m]
constexpr double kMaxRadius = 10;      // [m]
constexpr double kMaxOffset = 100;     // [m]

bool is_usable(const Sphere& sphere) {
  return sphere.center.allFinite() && sphere.center.cwiseAbs().maxCoeff() <= kMaxOffset &&
         sphere.radius >= kLeastRadius && sphere.radius <= kMaxRadius;
}

double reach_from(const Eigen::Vector3d& center, const Sphere& sphere) {
  return (sphere.center - center).norm() + sphere.radius;
}

}  // namespace

std::size_t SphereSet::size() const noexcept {
  std::size_t n = 0;
  for (const LinkSpheres& link : links) n += link.spheres.size();
  return n;
}

Sphere bounding_sphere(std::span<const Sphere> spheres) {
  if (spheres.size() == 1) return spheres.front();
  Eigen::Vector3d low = spheres.front().center, high = low;
  for (const Sphere& sphere : spheres) {
    low = low.cwiseMin(sphere.center - Eigen::Vector3d::Constant(sphere.radius));
    high = high.cwiseMax(sphere.center + Eigen::Vector3d::Constant(sphere.radius));
  }
  Eigen::Vector3d center = 0.5 * (low + high);
  // Steps towards the farthest sphere, ever shorter (M. Badoiu and K. Clarkson, 2003).
  for (int round = 1; round <= 200; ++round) {
    const Sphere& far =
        *std::max_element(spheres.begin(), spheres.end(), [&](const Sphere& a, const Sphere& b) {
          return reach_from(center, a) < reach_from(center, b);
        });
    const Eigen::Vector3d away = far.center - center;
    const double length = away.norm();
    if (length > 0) center += away * (reach_from(center, far) / length / (round + 20));
  }
  double radius = 0;
  for (const Sphere& sphere : spheres) radius = std::max(radius, reach_from(center, sphere));
  return {center, radius};
}

Result<void> check_sphere_set(const SphereSet& set, const Arm& arm) {
  if (set.links.empty() || set.links.size() > kMaxSphereLinks || set.size() > kMaxSpheres) {
    return fail(Errc::bad_input, text(msg::collision_sphere_count, set.size(), kMaxSpheres,
                                      set.links.size(), kMaxSphereLinks));
  }
  for (const LinkSpheres& link : set.links) {
    if (link.joint < -1 || link.joint >= arm.dof()) {
      return fail(Errc::bad_input,
                  text(msg::collision_link_joint, link.name, link.joint, arm.dof()));
    }
    if (link.spheres.empty() || !std::all_of(link.spheres.begin(), link.spheres.end(), is_usable)) {
      return fail(Errc::bad_input, text(msg::collision_link_spheres, link.name));
    }
  }
  if (set.pairs.size() > kMaxSpherePairs) {
    return fail(Errc::bad_input,
                text(msg::collision_many_pairs, set.pairs.size(), kMaxSpherePairs));
  }
  const auto is_link = [&](int i) { return i >= 0 && i < static_cast<int>(set.links.size()); };
  for (const auto& [a, b] : set.pairs) {
    if (!is_link(a) || !is_link(b) ||
        set.links[static_cast<std::size_t>(a)].joint ==
            set.links[static_cast<std::size_t>(b)].joint) {
      return fail(Errc::bad_input, text(msg::collision_link_pair, a, b));
    }
  }
  return {};
}

}  // namespace mjarm
