#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/posture.hpp"
#include "mjarm/path/clearance.hpp"
#include "mjarm/program/detour_planner_internal.hpp"
#include "mjarm/program/program_steps_internal.hpp"

namespace mjarm::program::detail {

/// Answers to a pose in the order in which they are tried.
struct Answers {
  std::vector<JointVec> q;
  std::size_t good = 0;  ///< so many of the first are not clearly worse than the very first

  [[nodiscard]] std::span<const JointVec> good_ones() const { return std::span(q).first(good); }
  [[nodiscard]] std::span<const JointVec> others() const { return std::span(q).subspan(good); }
};

/// Why a pose has no answer for a step.
struct NoAnswer {
  std::string reason;  ///< word
  std::string what;    ///< one line for people
};

/// Which answers to a pose a step may go to, and in which order they are tried: those of the branch
/// that is asked for; where the choice is free the best posture first, else the nearest.
class AnswerChoice {
 public:
  /// @param ik         whose answers are asked for.
  /// @param clearance  may be empty: distances do not count.
  AnswerChoice(const IkSolver& ik, const ClearanceCheck& clearance);

  /// @param q  shape (dof,); where the arm is.
  [[nodiscard]] Result<Answers, NoAnswer> to(const Step& step, const Pose& X_WT,
                                             const JointVec& q) const;
  /// Where a `plan` may end: its joint values, or the answers to its pose.
  [[nodiscard]] Result<Answers, NoAnswer> goals(const Step& step, const DetourPlanner& planner,
                                                const JointVec& q) const;
  /// Out of these, which are sorted by their distance from `q`.
  [[nodiscard]] Result<Answers, NoAnswer> among(const Step& step, std::vector<JointVec> answers,
                                                const JointVec& q) const;

 private:
  IkSolver ik_;
  PostureCost cost_;
  ClearanceMeasure clearance_;
};

}  // namespace mjarm::program::detail
