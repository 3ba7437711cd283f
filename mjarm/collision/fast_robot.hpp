#pragma once

#include <memory>

#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

namespace detail {
struct FastAccess;
struct FastRobotData;
}  // namespace detail

inline constexpr double kMaxSphereMargin = 10;  ///< [m]

/// What has to be kept for a configuration to count as free.
struct SphereMargins {
  double obstacles = 0;  ///< [m] 0 to kMaxSphereMargin: moving links from every obstacle
  double links = 0;      ///< [m] 0 to kMaxSphereMargin: paired links from each other
};

/// An arm and its spheres, made ready for FastChecker: any arm, read at run time. Immutable and
/// cheap to copy.
class FastRobot {
 public:
  /// A joint without stops is taken within two turns (a slide: 10 m) to either side.
  /// @return check_sphere_set()'s error; bad_input for an arm without joints or with too many, and
  /// for margins out of range.
  [[nodiscard]] static Result<FastRobot> create(const Arm& arm, const SphereSet& set,
                                                const SphereMargins& margins = {});

  [[nodiscard]] int dof() const noexcept;
  [[nodiscard]] const Arm& arm() const noexcept;
  [[nodiscard]] const SphereSet& spheres() const noexcept;  ///< as given, without the margins
  [[nodiscard]] const SphereMargins& margins() const noexcept;
  /// [m] by how much the radii grow to make up for single precision; a sphere of the set that keeps
  /// this far (two spheres: twice as far) from everything is never called in collision.
  [[nodiscard]] double padding() const noexcept;

 private:
  friend struct detail::FastAccess;
  explicit FastRobot(std::shared_ptr<const detail::FastRobotData> data) : data_(std::move(data)) {}
  std::shared_ptr<const detail::FastRobotData> data_;
};

}  // namespace mjarm
