#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "mjarm/collision/fast_robot.hpp"
#include "mjarm/collision/fast_tables_internal.hpp"
#include "mjarm/kinematics/link_chain.hpp"

namespace mjarm::detail {

/// [rad or m] how far outside of the limits a configuration still counts.
inline constexpr double kLimitSlack = 2e-4;
/// [m] clearances are reported up to here.
inline constexpr double kMaxClearance = 1;

/// What a group can do, in double precision.
struct GroupBounds {
  Eigen::Vector3d reach_center_W = Eigen::Vector3d::Zero();
  double reach = 0;  ///< [m] all spheres stay within this distance of that point
  /// Largest distance of a sphere's centre from the axis of joint k [m], over all configurations;
  /// for a slide 1: so much a centre moves a unit of q_k.
  std::array<double, kMaxDof> levers{};
  double padding = 0;  ///< [m] of the radii
};

/// The arrays behind FastLevers, rounded up, rows filled up with zeros.
struct LeverTable {
  std::vector<float> levers;
  std::vector<int> from;

  FastLevers tables() const { return {static_cast<int>(from.size()), levers.data(), from.data()}; }
};

struct FastRobotData {
  FastRobotData() = default;
  FastRobotData(const FastRobotData&) = delete;  // the tables point into it
  FastRobotData& operator=(const FastRobotData&) = delete;

  Arm arm;
  SphereSet set;
  SphereMargins margins;
  std::vector<FastGroup> groups;
  std::vector<FastPart> parts;
  std::vector<FastSphere> spheres;
  std::vector<FastPair> pairs, every_pair;
  std::vector<FastApart> apart;
  std::vector<std::uint8_t> apart_cells;
  std::vector<FastRow> rows;
  std::vector<FastPartPair> part_pairs;
  std::vector<FastPartners> partners;
  FastRobotTables tables;                                     ///< of the above
  std::vector<GroupBounds> bounds;                            ///< one a group
  std::vector<std::array<double, kMaxDof>> levers_of_sphere;  ///< as in GroupBounds
  std::vector<int> link_of_sphere;                            ///< index into the set
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< axes of body 0, whose origin is W's
  double padding = 0;                                  ///< [m] largest of the groups
  /// Of every group and, of every pair, those of group b for the joints between both.
  LeverTable group_levers, pair_levers;
};

/// The next float towards infinity, or towards minus infinity.
inline float round_up(double x) {
  const float f = static_cast<float>(x);
  return f >= x ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
}
inline float round_down(double x) { return -round_up(-x); }

/// The widest limits that are looked at, finite.
struct FastLimits {
  double lower, upper;
};
[[nodiscard]] FastLimits fast_limits(const Arm& arm, int joint);

/// The spheres of every link in the frame of its body, as LinkChain has it.
[[nodiscard]] std::vector<std::vector<Sphere>> spheres_in_bodies(const SphereSet& set,
                                                                 const Arm& arm,
                                                                 const LinkChain& chain);

/// Bounds for points fixed to body `body` (from 1), the centres of spheres `spheres` in its frame.
[[nodiscard]] GroupBounds group_bounds(const Arm& arm, const LinkChain& chain, int body,
                                       std::span<const Sphere> spheres);

/// Fills all kinds of pairs of a robot whose groups are there.
void add_pairs(FastRobotData& data, const LinkChain& chain);

/// Makes tables for pairs of groups with few joints between them.
void add_apart(FastRobotData& data, const LinkChain& chain);

}  // namespace mjarm::detail
