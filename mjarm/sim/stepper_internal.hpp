#pragma once

#include <vector>

#include "mjarm/sim/follow.hpp"

namespace mjarm {

/// The one loop under all followers: command, step, record, measure.
class Stepper {
 public:
  explicit Stepper(const FollowSetup& setup);

  /// One step towards `reference`.
  /// @return false where `after_step` asked to stop, an error where the simulation broke down.
  [[nodiscard]] Result<bool> step(const StepReference& reference);

  /// Outcome so far, with the errors at this moment against the reference of the last step.
  [[nodiscard]] FollowOutcome outcome() const;
  /// How far each joint is from the reference of the last step, q_ref - q.
  [[nodiscard]] JointVec error() const;
  [[nodiscard]] bool limited() const { return limited_; }  ///< in the last step
  void reached_one() { ++outcome_.reached; }

 private:
  void measure(const JointVec& q_ref);

  const FollowSetup& setup_;
  FollowOutcome outcome_;
  std::vector<double> ctrl_;
  JointVec q_ref_;
  double start_;
  bool limited_ = false;
  bool broken_ = false;
};

}  // namespace mjarm
