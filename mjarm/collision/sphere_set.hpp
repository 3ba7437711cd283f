#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// A solid ball.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m] in the frame the owner names
  double radius = 0;                                 ///< [m] > 0
};

/// The spheres that stand for one rigid piece of a robot.
struct LinkSpheres {
  std::string name;
  /// The joint of the arm that moves it, from 0: centres are in its frame J. -1: the piece stands
  /// still, and its centres are in the world.
  int joint = -1;
  std::vector<Sphere> spheres;  ///< at least one
};

/// A robot as spheres. A plain value: from a problem file as it is, or made by cover_model().
struct SphereSet {
  std::vector<LinkSpheres> links;
  /// Links (by index) that must not overlap each other.
  std::vector<std::array<int, 2>> pairs;

  [[nodiscard]] std::size_t size() const noexcept;  ///< number of spheres
};

/// Most spheres of a set, links and pairs of links in it.
inline constexpr std::size_t kMaxSpheres = 512;
inline constexpr std::size_t kMaxSphereLinks = 128;
inline constexpr std::size_t kMaxSpherePairs = 1024;

/// A ball that contains all of `spheres` (not empty), at most a few percent larger than the least.
[[nodiscard]] Sphere bounding_sphere(std::span<const Sphere> spheres);

/// Looks whether the set belongs to `arm`: known joints, finite numbers, radii from 1e-6 to 10 m,
/// centres within 100 m, pairs of different links that a joint can move against each other.
/// @return bad_input: one line that names the link.
[[nodiscard]] Result<void> check_sphere_set(const SphereSet& set, const Arm& arm);

}  // namespace mjarm
