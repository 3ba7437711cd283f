#include "mjarm/session/near_spheres.hpp"

#include <algorithm>

#include "mjarm/kinematics/fk.hpp"

namespace mjarm::session {
namespace {

/// An obstacle by its index among solids and clouds.
double distance_to(const Obstacles& obstacles, int index, const Eigen::Vector3d& p_W) {
  const auto i = static_cast<std::size_t>(index);
  const std::size_t solids = obstacles.solids.size();
  return i < solids ? distance(obstacles.solids[i], p_W)
                    : distance(obstacles.clouds[i - solids], p_W);
}

int count_of(const Obstacles& obstacles) {
  return static_cast<int>(obstacles.solids.size() + obstacles.clouds.size());
}

void keep_nearer(std::optional<SphereNeighbour>& nearest, const SphereNeighbour& other) {
  if (!nearest || other.distance < nearest->distance) nearest = other;
}

/// The point of an obstacle that is nearest to `p_W`: against the gradient of the distance.
Eigen::Vector3d nearest_point(const Obstacles& obstacles, int index, const Eigen::Vector3d& p_W) {
  constexpr double kStep = 1e-6;  // [m]
  Eigen::Vector3d gradient;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    gradient[k] =
        distance_to(obstacles, index, p_W + step) - distance_to(obstacles, index, p_W - step);
  }
  if (!(gradient.norm() > 0)) return p_W;  // inside
  return p_W - distance_to(obstacles, index, p_W) * gradient.normalized();
}

}  // namespace

std::vector<PlacedSphere> place_spheres(const FastRobot& robot, std::span<const double> q) {
  std::vector<Pose> X_WJ(static_cast<std::size_t>(robot.dof()));
  fk_all(robot.arm(), q, X_WJ);
  std::vector<PlacedSphere> out;
  out.reserve(robot.spheres().size());
  for (std::size_t i = 0; i < robot.spheres().links.size(); ++i) {
    const LinkSpheres& link = robot.spheres().links[i];
    const Pose X_WL = link.joint < 0 ? Pose() : X_WJ[static_cast<std::size_t>(link.joint)];
    for (const Sphere& sphere : link.spheres) {
      out.push_back({static_cast<int>(i), X_WL * sphere.center, sphere.radius});
    }
  }
  return out;
}

SphereNeighbours obstacle_neighbours(const SphereSet& set, const Obstacles& obstacles,
                                     std::span<const PlacedSphere> placed,
                                     const SphereClearance* only) {
  SphereNeighbours out(placed.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const PlacedSphere& sphere = placed[i];
    if (set.links[static_cast<std::size_t>(sphere.link)].joint < 0) continue;
    for (int k = 0; k < count_of(obstacles); ++k) {
      if (only != nullptr && (only->link != sphere.link || only->obstacle != k)) continue;
      const IgnoredPair pair{sphere.link, k};
      if (std::ranges::find(obstacles.ignored, pair) != obstacles.ignored.end()) continue;
      keep_nearer(out[i], {distance_to(obstacles, k, sphere.p_W) - sphere.radius, k, -1});
    }
  }
  return out;
}

SphereNeighbours link_neighbours(const SphereSet& set, std::span<const PlacedSphere> placed) {
  SphereNeighbours out(placed.size());
  const auto place = [&set](int a, int b) {
    return static_cast<std::size_t>(a) * set.links.size() + static_cast<std::size_t>(b);
  };
  std::vector<bool> paired(set.links.size() * set.links.size());
  for (const auto& [a, b] : set.pairs) paired[place(a, b)] = paired[place(b, a)] = true;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      if (!paired[place(placed[i].link, placed[j].link)]) continue;
      const double gap =
          (placed[i].p_W - placed[j].p_W).norm() - placed[i].radius - placed[j].radius;
      keep_nearer(out[i], {gap, -1, static_cast<int>(j)});
      keep_nearer(out[j], {gap, -1, static_cast<int>(i)});
    }
  }
  return out;
}

std::optional<ClosestPair> closest_pair(const Obstacles& obstacles,
                                        std::span<const PlacedSphere> placed,
                                        const SphereNeighbours& to_obstacles,
                                        const SphereNeighbours& to_links) {
  std::optional<ClosestPair> out;
  for (const SphereNeighbours* neighbours : {&to_obstacles, &to_links}) {
    for (std::size_t i = 0; i < neighbours->size(); ++i) {
      const std::optional<SphereNeighbour>& to = (*neighbours)[i];
      if (!to || (out && to->distance >= out->to.distance)) continue;
      out = ClosestPair{static_cast<int>(i), *to};
    }
  }
  if (!out) return out;
  const PlacedSphere& first = placed[static_cast<std::size_t>(out->sphere)];
  if (out->to.obstacle >= 0) {
    out->p2_W = nearest_point(obstacles, out->to.obstacle, first.p_W);
  } else {
    const PlacedSphere& other = placed[static_cast<std::size_t>(out->to.sphere)];
    out->p2_W = other.p_W + other.radius * (first.p_W - other.p_W).normalized();
  }
  out->p1_W = first.p_W + first.radius * (out->p2_W - first.p_W).normalized();
  if (out->to.distance <= 0) out->p2_W = out->p1_W;
  return out;
}

}  // namespace mjarm::session
