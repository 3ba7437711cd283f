#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm {

/// What makes one of several postures better, as weights >= 0. Every default is usable as is.
struct PostureWeights {
  double clearance = 4;            ///< of nothing left; falls to 0 at `enough_clearance`
  double middle = 2;               ///< of a joint at its limit, over the number of joints
  double elbow = 1;                ///< of an elbow below the line from the shoulder to the wrist
  double travel = 0.5;             ///< of a joint's way of pi rad or 1 m from where the arm is
  double enough_clearance = 0.05;  ///< [m] > 0
};

/// Weighs the postures of one arm where nothing else decides between them.
class PostureCost {
 public:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  explicit PostureCost(const IkSolver& ik, PostureWeights weights = {});

  /// What is to be said against `q`, shape (dof,) [rad or m]: >= 0, smaller is better.
  /// @param clearance  [m] to what is nearest; where that is not known: far.
  [[nodiscard]] double at(std::span<const double> q, double clearance = kFar) const noexcept;
  /// The cost of the way from `q_near` to `q`.
  [[nodiscard]] double travel(const JointVec& q, const JointVec& q_near) const noexcept;
  [[nodiscard]] const PostureWeights& weights() const noexcept { return weights_; }

 private:
  [[nodiscard]] double off_middle(std::span<const double> q) const noexcept;

  IkSolver ik_;
  PostureWeights weights_;
};

/// Measures the clearance of a configuration [m]; < 0 in contact. Empty: not known.
using ClearanceMeasure = std::function<double(std::span<const double> q)>;

/// Sorts answers to one pose, those with the better posture first; of equals as they stood.
/// @param q_near  shape (dof,); where the arm is.
/// @return the cost of each, ascending.
std::vector<double> sort_by_posture(const PostureCost& cost, std::vector<JointVec>& answers,
                                    std::span<const double> q_near,
                                    const ClearanceMeasure& clearance);

}  // namespace mjarm
