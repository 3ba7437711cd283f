#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/collision/convex_internal.hpp"
#include "mjarm/collision/fast_robot.hpp"
#include "mjarm/collision/near_boxes_internal.hpp"
#include "mjarm/collision/obstacles.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::detail {

/// [m] What has to be left between two solids for them to count as apart: more than the rounding of
/// any program that looks at them.
inline constexpr double kSolidSpare = 3e-5;

/// A convex piece of a link.
struct LinkSolid {
  Convex convex;  ///< in the frame J of the joint
  int link = 0;
  int joint = 0;  ///< that moves it
  /// [m a radian, or 1] Largest distance of a point of the core from the axis of each joint.
  std::array<double, kMaxDof> levers{};
};

/// What stands round the arm: a convex solid, a half-space (z <= 0) or ground, in the world.
struct StandingSolid {
  enum class Kind { convex, half_space, ground } kind = Kind::convex;
  std::optional<Convex> convex;
  Pose X_WO;
  HeightFieldShape ground;            ///< as MuJoCo has it: a prism under each triangle
  Eigen::Vector3d low, high;          ///< [m] a box round it
  std::vector<std::uint8_t> ignored;  ///< per link: not held against it
};

/// [m] No more than the distance of a convex solid from one that stands: exact up to `enough`.
[[nodiscard]] double gap_to_standing(const Convex& convex, const Pose& X_WC,
                                     const StandingSolid& standing, double enough) noexcept;

/// [m] A point of what stands is no farther than this from a place; infinite where that is more
/// than `enough`.
[[nodiscard]] double distance_to_standing(const Eigen::Vector3d& p_W, const StandingSolid& standing,
                                          double enough) noexcept;

/// An arm and its scene as the solids that MuJoCo collides: convex ones, exactly. What spheres
/// cannot call free is looked at here. Immutable; may be used from many threads at once.
class SolidScene {
 public:
  /// Two things that are near each other; -1: not that.
  struct Pair {
    int link = -1, obstacle = -1, other_link = -1;
  };
  [[nodiscard]] std::span<const LinkSolid> solids() const noexcept { return solids_; }
  [[nodiscard]] std::span<const StandingSolid> standing() const noexcept { return standing_; }

  struct Clearance {
    double distance = 0;  ///< [m] negative: depth of the overlap
    Pair pair;
  };

  /// @param solids  grouped by link.
  /// @param pairs   of links, each in any order.
  SolidScene(Arm arm, std::vector<LinkSolid> solids, std::vector<StandingSolid> standing,
             std::span<const std::array<int, 2>> pairs);

  /// How far a configuration may move along `way` to both sides and is proved to keep the margins,
  /// at most `half`: q + t way for |t| <= that. Negative where it does not keep them itself, by
  /// less than kSolidSpare at most.
  /// @param q, way  shape (dof,) [rad or m].
  [[nodiscard]] double free_half(std::span<const double> q, std::span<const double> way,
                                 double half, const SphereMargins& margins) const noexcept;

  /// Whether a configuration keeps the margins.
  [[nodiscard]] bool is_free(std::span<const double> q,
                             const SphereMargins& margins) const noexcept;

  /// [m] No solid gets farther, nor as seen from another, where each joint moves by no more.
  /// @param off  shape (dof,) [rad or m] >= 0.
  [[nodiscard]] double farthest(std::span<const double> off) const noexcept;

  /// What is nearest; margins are taken off. Nothing within `max` [m]: that, and no pair.
  [[nodiscard]] Clearance clearance(std::span<const double> q, double max,
                                    const SphereMargins& margins) const noexcept;

 private:
  class Moment;
  /// Solids of a link, and a ball round them.
  struct LinkGroup {
    int joint = 0;
    std::size_t first = 0, end = 0;
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< in J
    double reach = 0;                                  ///< [m]
    std::array<double, kMaxDof> levers{};
  };

  Arm arm_;
  std::vector<LinkSolid> solids_;
  std::vector<LinkGroup> links_;
  std::vector<StandingSolid> standing_;
  NearBoxes boxes_;                        // round what stands
  std::vector<std::array<int, 2>> pairs_;  // the link nearer to the base first
};

}  // namespace mjarm::detail
