#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mjarm/collision/verify_edge.hpp"
#include "mjarm/core/pose.hpp"

namespace mjarm::detail {

/// A link against an obstacle or another link: proved to be apart on [0, until].
struct Watch {
  double until = 0;  ///< t
  double bend = 0;   ///< [m] bound of the second derivative of a place on `link`, seen from `base`
  int link = 0;
  int base = -1;      ///< the joint that moves the other one; -1: the world
  int obstacle = -1;  ///< -1: a link
  int other_link = -1;
  double keep = 0;  ///< [m] distance that is to be kept
};

/// Velocity [m a unit of t] of a place, as a field over the world.
struct Twist {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< of the world's origin
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& p) const { return turn.cross(p) + shift; }
};

/// The nearest of a watch at one t, and how far along the edge it is proved to stay apart.
struct Look {
  double clearance = std::numeric_limits<double>::infinity();  ///< [m] nothing taken off
  double step = std::numeric_limits<double>::infinity();       ///< in t
  bool overlaps = false;

  /// Takes in a distance that is off by `rounding` [m] at most, and how fast it changes: it is at
  /// least `distance + slope h - bend h^2 / 2` after a step h.
  /// @param need  [m] what it must not become less than.
  void add(double distance, double need, double rounding, double slope, double bend);
};

/// What links are marched against.
class MarchGeometry {
 public:
  virtual ~MarchGeometry() = default;
  [[nodiscard]] virtual int links() const = 0;
  [[nodiscard]] virtual int joint_of(int link) const = 0;  ///< -1: it is at rest
  /// [m] no place of the link that matters is farther from the origin of its joint.
  [[nodiscard]] virtual double reach_of(int link) const = 0;
  [[nodiscard]] virtual int obstacles() const = 0;
  [[nodiscard]] virtual bool is_held(int link, int obstacle) const = 0;
  [[nodiscard]] virtual std::span<const std::array<int, 2>> pairs() const = 0;
  /// @param X_WJ   of every joint.
  /// @param twist  how the link moves, seen from Watch::base.
  virtual void look(const Watch& watch, std::span<const Pose> X_WJ, const Twist& twist, double need,
                    Look& out) = 0;
};

/// Marches every link along an edge (verify_edge()).
[[nodiscard]] Result<VerifyResult> march(const Arm& arm, MarchGeometry& geometry,
                                         std::span<const double> q0, std::span<const double> q1,
                                         const VerifyOptions& options);

}  // namespace mjarm::detail
