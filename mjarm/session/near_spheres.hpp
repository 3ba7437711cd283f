#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/obstacles.hpp"

namespace mjarm::session {

/// A sphere of a robot where it is now, in the world frame W.
struct PlacedSphere {
  int link = -1;                                  ///< index into the sphere set
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0;                              ///< [m]
};

/// All spheres of a robot at `q`, shape (dof,) [rad or m], in the order of its set.
[[nodiscard]] std::vector<PlacedSphere> place_spheres(const FastRobot& robot,
                                                      std::span<const double> q);

/// What a sphere is nearest to, in double precision.
struct SphereNeighbour {
  double distance = 0;  ///< [m] between the surfaces, negative where they overlap
  int obstacle = -1;    ///< index among solids and clouds; -1: a sphere
  int sphere = -1;      ///< that sphere, by its place in `placed`
};

/// What each sphere is nearest to.
using SphereNeighbours = std::vector<std::optional<SphereNeighbour>>;

/// The nearest obstacle of each sphere; none for a sphere at rest and for one that may touch them
/// all. Takes time in proportion to spheres by obstacles, points and faces.
/// @param only  where given, only its link is held against its obstacle.
[[nodiscard]] SphereNeighbours obstacle_neighbours(const SphereSet& set, const Obstacles& obstacles,
                                                   std::span<const PlacedSphere> placed,
                                                   const SphereClearance* only = nullptr);

/// The nearest sphere of each, of links that must not overlap.
[[nodiscard]] SphereNeighbours link_neighbours(const SphereSet& set,
                                               std::span<const PlacedSphere> placed);

/// Two things that must not touch, where they are nearest to each other.
struct ClosestPair {
  int sphere = -1;  ///< by its place in `placed`
  SphereNeighbour to;
  Eigen::Vector3d p1_W = Eigen::Vector3d::Zero();  ///< [m] on the sphere
  Eigen::Vector3d p2_W = Eigen::Vector3d::Zero();  ///< [m] on the other; where they overlap, `p1_W`
};

/// The nearest of all, with its points; none where no sphere has a neighbour.
[[nodiscard]] std::optional<ClosestPair> closest_pair(const Obstacles& obstacles,
                                                      std::span<const PlacedSphere> placed,
                                                      const SphereNeighbours& to_obstacles,
                                                      const SphereNeighbours& to_links);

}  // namespace mjarm::session
