#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/collision/fast_robot.hpp"
#include "mjarm/collision/obstacles.hpp"
#include "mjarm/core/cpu.hpp"

namespace mjarm {

namespace detail {
struct FastAccess;
struct FastWorld;
struct FastKernels;
struct FastNearest;
class SolidScene;
}  // namespace detail

/// [m] What keeps this far from everything is never called in collision by a checker that looks
/// closer.
inline constexpr double kSolidClearance = 1e-4;

/// How far a configuration is from its nearest collision, as a lower bound.
struct SphereClearance {
  /// [m] no sphere is nearer than this to an obstacle or to a sphere it is paired with; negative
  /// where they overlap, at most 1. Links at rest count against moving links only.
  double distance = 1;
  int link = -1;        ///< of the nearest pair, by index into the sphere set; -1: none within 1 m
  int obstacle = -1;    ///< the other of the pair, by its index among solids and clouds; -1: a link
  int other_link = -1;  ///< that link
};

/// Collision checks of many configurations at once: forward kinematics and spheres against solids
/// and each other, as many at a time as the registers of this machine hold. Single precision, but
/// every radius is padded by a bound of what that can do, so that a configuration that is called
/// free is free; what keeps FastRobot::padding() (two links: twice) away is never called in
/// collision, but beside solid meshes: their faces get thicker where spheres are small against
/// them. Immutable; may be used from many threads at once. The same input gives the same answer on
/// one level of SIMD.
///
/// One that looks closer asks the exact convex solids of a model where spheres overlap: then what
/// keeps the margins and kSolidClearance is called free, whatever the spheres stick out by.
class FastChecker {
 public:
  /// Takes the obstacles apart; they are not needed afterwards.
  /// @param level  instructions to use; more than this machine has are not taken.
  /// @return check_obstacles()'s error.
  [[nodiscard]] static Result<FastChecker> create(FastRobot robot, const Obstacles& obstacles,
                                                  SimdLevel level = simd_level());

  /// The same, looking closer.
  /// @param solids   ModelCover::solids, of the cover that robot and obstacles are from; null: not.
  /// @param margins  where given, less than those of the robot: as little counts where solids tell.
  [[nodiscard]] FastChecker looking_closer(std::shared_ptr<const detail::SolidScene> solids,
                                           std::optional<SphereMargins> margins = {}) const;
  [[nodiscard]] const std::shared_ptr<const detail::SolidScene>& solids() const noexcept {
    return solids_;
  }

  /// Whether each configuration is free; one outside of the limits (by more than 2e-4) or with a
  /// number that is not finite is not.
  /// @param q     shape (n, dof), row by row [rad or m].
  /// @param free  shape (n,): 1 or 0.
  void check(std::span<const double> q, std::span<std::uint8_t> free) const noexcept;
  /// The same for one of shape (dof,).
  [[nodiscard]] bool is_free(std::span<const double> q) const noexcept;

  /// Whether all of these are free: ends with the first block that shows one that is not.
  /// @param q  shape (n, dof), row by row [rad or m].
  [[nodiscard]] bool all_free(std::span<const double> q) const noexcept;

  /// Lower bounds of the clearance of configurations within the limits; exact for one that looks
  /// closer.
  /// @param q    shape (n, dof), row by row [rad or m], finite.
  /// @param max  [m] <= 1: that, and no pair, where nothing is as near.
  void clearances(std::span<const double> q, std::span<SphereClearance> out,
                  double max = 1) const noexcept;
  [[nodiscard]] SphereClearance clearance(std::span<const double> q) const noexcept;

  /// The least clearance of several configurations, faster than all of them. Where some overlap, it
  /// is that of one of these.
  struct LeastClearance {
    SphereClearance nearest;
    std::size_t row = 0;  ///< of `q`
  };
  /// @param q  as for clearances(), at least one row.
  [[nodiscard]] LeastClearance least_clearance(std::span<const double> q) const;

  /// The link at rest and the obstacle that overlap, which no configuration can undo.
  struct FixedOverlap {
    int link = -1, obstacle = -1;
  };
  [[nodiscard]] const std::optional<FixedOverlap>& fixed_overlap() const noexcept {
    return fixed_overlap_;
  }

  [[nodiscard]] const FastRobot& robot() const noexcept { return robot_; }
  /// Configurations that are looked at at once.
  [[nodiscard]] int width() const noexcept;

 private:
  friend struct detail::FastAccess;
  FastChecker(FastRobot robot, const Obstacles& obstacles, SimdLevel level);
  /// The block of width() configurations from row `first` on.
  /// @param any  end with the first that collides.
  /// @return bit k: row first + k collides; with `any` only whether it is zero counts.
  [[nodiscard]] std::uint32_t collide(std::span<const double> q, std::size_t first,
                                      bool any) const noexcept;
  [[nodiscard]] SphereClearance clearance_of(const detail::FastNearest& from) const noexcept;
  void sphere_clearances(std::span<const double> q, std::span<SphereClearance> out,
                         double max) const noexcept;
  [[nodiscard]] LeastClearance least_looking_closer(std::span<const double> q) const;
  [[nodiscard]] SphereClearance closer_clearance(std::span<const double> q,
                                                 double max) const noexcept;
  /// Of lanes that collide those that still do when looked at closer.
  [[nodiscard]] std::uint32_t look_closer(std::span<const double> rows, std::uint32_t hit,
                                          bool any) const noexcept;

  FastRobot robot_;
  std::shared_ptr<const detail::FastWorld> world_;
  const detail::FastKernels* kernels_;
  std::optional<FixedOverlap> fixed_overlap_;
  std::shared_ptr<const detail::SolidScene> solids_;  // null: it does not look closer
  SphereMargins closer_;                              // margins of the solids
};

}  // namespace mjarm
