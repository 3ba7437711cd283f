#include "mjarm/collision/verify_edge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mjarm/collision/edge_march_internal.hpp"

namespace mjarm {
namespace {

using detail::Look;
using detail::Twist;
using detail::Watch;

constexpr double kRounding = 1e-12;    // of a distance, a metre of coordinates
constexpr double kSlopeLength = 1e-6;  // [m] way over which a slope is measured
constexpr double kLeastSpeed = 1e-30;  // [m a unit of t] below which no slope is measured

/// Whether the distance to a shape is a convex function of the place.
struct IsConvex {
  bool operator()(const MeshShape&) const { return false; }
  bool operator()(const HeightFieldShape&) const { return false; }
  template <class Shape>
  bool operator()(const Shape&) const {
    return true;
  }
};

/// Spheres against solids, clouds and each other.
class SphereMarch : public detail::MarchGeometry {
 public:
  SphereMarch(const SphereSet& set, const Obstacles& obstacles)
      : set_(set), obstacles_(obstacles) {}

  int links() const override { return static_cast<int>(set_.links.size()); }
  int joint_of(int link) const override { return link_at(link).joint; }
  double reach_of(int link) const override {
    double reach = 0;
    for (const Sphere& sphere : link_at(link).spheres) {
      reach = std::max(reach, sphere.center.norm());
    }
    return reach;
  }
  int obstacles() const override {
    return static_cast<int>(obstacles_.solids.size() + obstacles_.clouds.size());
  }
  bool is_held(int link, int obstacle) const override {
    const auto& ignored = obstacles_.ignored;
    return std::find(ignored.begin(), ignored.end(), IgnoredPair{link, obstacle}) == ignored.end();
  }
  std::span<const std::array<int, 2>> pairs() const override { return set_.pairs; }

  void look(const Watch& watch, std::span<const Pose> X_WJ, const Twist& twist, double need,
            Look& out) override {
    for (const Sphere& sphere : link_at(watch.link).spheres) {
      const Eigen::Vector3d p = center_of(watch.link, sphere, X_WJ);
      const Place place{p, twist.at(p), sphere.radius, need, watch.bend};
      if (watch.obstacle >= 0) {
        look_at_obstacle(static_cast<std::size_t>(watch.obstacle), place, out);
        continue;
      }
      for (const Sphere& other : link_at(watch.other_link).spheres) {
        const Eigen::Vector3d center = center_of(watch.other_link, other, X_WJ);
        look_at([&](const Eigen::Vector3d& x) { return (x - center).norm(); }, place, other.radius,
                kRounding * (1 + p.norm() + center.norm()), out);
      }
    }
  }

 private:
  /// A point that moves with `v`, the radius round it, and what is kept beyond that.
  struct Place {
    Eigen::Vector3d p, v;
    double radius, need, bend;
  };

  const LinkSpheres& link_at(int link) const { return set_.links[static_cast<std::size_t>(link)]; }

  Eigen::Vector3d center_of(int link, const Sphere& sphere, std::span<const Pose> X_WJ) const {
    const int joint = joint_of(link);
    return joint < 0 ? sphere.center : X_WJ[static_cast<std::size_t>(joint)] * sphere.center;
  }

  void look_at_obstacle(std::size_t index, const Place& place, Look& out) const {
    if (index < obstacles_.solids.size()) {
      const Obstacle& solid = obstacles_.solids[index];
      const auto distance_to = [&](const Eigen::Vector3d& x) { return distance(solid, x); };
      const double rounding = kRounding * (1 + place.p.norm() + (place.p - solid.X_WO.p).norm());
      look_at(distance_to, place, 0, rounding, out, std::visit(IsConvex(), solid.shape));
      return;
    }
    const PointCloud& cloud = obstacles_.clouds[index - obstacles_.solids.size()];
    for (const Eigen::Vector3d& point : cloud.points_W) {
      look_at([&](const Eigen::Vector3d& x) { return (x - point).norm(); }, place, cloud.radius,
              kRounding * (1 + place.p.norm() + point.norm()), out);
    }
  }

  /// Looks at a point that must stay its radius and `radius` away from something.
  template <class Distance>
  static void look_at(const Distance& distance_to, const Place& place, double radius,
                      double rounding, Look& out, bool is_convex = true) {
    const double d = distance_to(place.p), speed = place.v.norm();
    double slope = -speed;
    if (is_convex && speed > kLeastSpeed) {
      // A convex function climbs at least as fast from here on as it did up to here.
      const double back = kSlopeLength / speed;
      slope = (d - rounding - distance_to(place.p - back * place.v)) / back;
    }
    out.add(d - place.radius - radius, place.need, rounding, slope, place.bend);
  }

  const SphereSet& set_;
  const Obstacles& obstacles_;
};

}  // namespace

Result<VerifyResult> verify_edge(const Arm& arm, const SphereSet& set, const Obstacles& obstacles,
                                 std::span<const double> q0, std::span<const double> q1,
                                 const VerifyOptions& options) {
  if (auto fits = check_sphere_set(set, arm); !fits) return fail(std::move(fits.error()));
  if (auto fits = check_obstacles(obstacles); !fits) return fail(std::move(fits.error()));
  SphereMarch spheres(set, obstacles);
  return detail::march(arm, spheres, q0, q1, options);
}

}  // namespace mjarm
