#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/joint_vec.hpp"

namespace mjarm {

/// Proves that what lies beside planned paths keeps what they keep: their clearance, and near
/// starts and goals with less than that what the paths keep there. Made by PlanningWorld::prover().
class WayProver {
 public:
  /// [m] that is proved at least, so that a way may be off by as much.
  static constexpr double kSpare = 1e-5;

  /// An end of a path that has less than the clearance itself.
  struct NearEnd {
    JointVec q;
    double radius;       ///< [rad or m, L2] how far from it less will do
    FastChecker narrow;  ///< that knows what is kept there
  };

  /// @param wide  calls free what keeps the clearance.
  WayProver(FastChecker wide, std::vector<NearEnd> ends)
      : wide_(std::move(wide)), ends_(std::move(ends)) {}

  /// Whether one configuration keeps it.
  [[nodiscard]] bool is_free(const JointVec& q) const;
  /// Whether the straight way is proved.
  [[nodiscard]] bool is_proved(const JointVec& from, const JointVec& to) const;
  /// Whether all is proved that lies within `beside` of the straight way in every joint. Does not
  /// try hard: where it fails a curve is better cut in two, whose ways it leaves by a quarter.
  /// @param beside  shape (dof,) [rad or m] >= 0.
  [[nodiscard]] bool is_proved(const JointVec& from, const JointVec& to,
                               const JointVec& beside) const;

 private:
  template <class Keeps>
  [[nodiscard]] bool any_keeps(std::initializer_list<const JointVec*> places,
                               const Keeps& keeps) const;
  [[nodiscard]] bool is_edge_free(const JointVec& from, const JointVec& to,
                                  const EdgeOptions& options) const;

  FastChecker wide_;
  std::vector<NearEnd> ends_;
};

}  // namespace mjarm
