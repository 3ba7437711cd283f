#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/joint_vec.hpp"

namespace mjarm {

/// Proves that a way beside planned paths keeps what they keep: their clearance, and near starts
/// and goals with less than that what the paths keep there. Made by PlanningWorld::prover().
class WayProver {
 public:
  /// [m] that is proved at least, for what lies between the samples of a way.
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

  /// The first of the straight pieces between neighbours that is not proved; their number where
  /// all are.
  /// @param way  shape (n,), n >= 1, each (dof,).
  [[nodiscard]] std::size_t first_unproved(std::span<const JointVec> way) const;
  [[nodiscard]] bool is_proved(std::span<const JointVec> way) const {
    return first_unproved(way) + 1 == way.size();
  }

 private:
  [[nodiscard]] bool is_proved(const JointVec& from, const JointVec& to) const;

  FastChecker wide_;
  std::vector<NearEnd> ends_;
};

}  // namespace mjarm
