#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/planning/tilt_limit.hpp"

namespace mjarm::detail {

/// Proves that edges keep to a TiltLimit, and puts configurations back to where they do.
class TiltKeeper {
 public:
  /// @param limit  is_sound().
  TiltKeeper(const TiltLimit& limit, const Arm& arm);

  /// That of a limit, where there is one.
  [[nodiscard]] static std::optional<TiltKeeper> create(const std::optional<TiltLimit>& limit,
                                                        const Arm& arm) {
    if (!limit) return std::nullopt;
    return TiltKeeper(*limit, arm);
  }
  [[nodiscard]] bool keeps(std::span<const double> q) const;

  /// Moves `q` the shortest way (Newton's method on the pseudo-inverse, as the projection of
  /// D. Berenson et al., CBiRRT, ICRA 2009) to where the tool leans by a part of the limit only;
  /// one that does already stays.
  /// @return false where that fails within the joint limits.
  [[nodiscard]] bool project(std::span<double> q) const;

  /// Writes to `out` the place a step of `range` from `from` towards `to`, put back within the
  /// limit.
  /// @param range  [rad or m, L2] > 0, less than what is between both.
  /// @return [rad or m, L2] length of the step, up to twice `range`; none where it leads nowhere.
  [[nodiscard]] std::optional<double> step(std::span<const double> from, std::span<const double> to,
                                           double range, std::span<double> out) const;

  /// What is known of the straight edge between two configurations.
  struct EdgeTilt {
    bool kept = false;   ///< proved
    double t = 0;        ///< where it is not kept, or not proved, 0 to 1
    double largest = 0;  ///< [rad] kept: the tool leans by no more anywhere on the edge
  };
  /// The lean w of the tool's direction u is its part across the axis of the world, |w| = sin tilt.
  /// Along an edge |u''| is at most L^2, where L sums the angles of the joints that can tilt the
  /// tool (u is a product of rotations about fixed axes times a fixed vector). So between two
  /// places |w| stays below the straight line between its values plus L^2 / 8, and u on its side of
  /// the world. Halves are looked at where that does not do.
  [[nodiscard]] EdgeTilt look(std::span<const double> q0, std::span<const double> q1) const;

 private:
  /// Direction u of the tool, seen along the axis of the world.
  struct Lean {
    Eigen::Vector2d across;
    double along = 1;
  };
  [[nodiscard]] Lean lean(std::span<const double> q) const;
  [[nodiscard]] bool keeps(const Lean& lean) const;
  void leave_out_turns(const Arm& arm);

  LinkChain chain_;
  JointLimits limits_;
  TiltLimit limit_;
  double max_sine_;
  Eigen::Matrix<double, 2, 3> across_;  ///< rows: two directions across axis_W
  int first_ = 0, last_ = 0;            ///< joints first_ <= k < last_ can tilt the tool
  std::array<bool, kMaxDof> turns_{};   ///< hinges
};

/// [rad or m, L2] steps of searches within a limit.
inline constexpr double kTiltRange = 0.3;

}  // namespace mjarm::detail
