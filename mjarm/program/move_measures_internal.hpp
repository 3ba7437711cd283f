#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/clearance.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program {

/// Waypoints of a straight joint move, near enough to each other to look at contact.
[[nodiscard]] std::vector<JointVec> joint_way(const JointVec& from, const JointVec& to);

/// Says how near an arm comes to limits, singularities and other things.
class MoveJudge {
 public:
  /// @param checker  of clearance(); none: contact is not looked at.
  /// @param shown    whose distances and nearest pairs are told; none: contact is not measured.
  MoveJudge(const Arm& arm, const std::optional<ExactChecker>& checker,
            const std::optional<ExactChecker>& shown);

  /// One line about the worst joint where `q` is beyond its limits.
  [[nodiscard]] std::optional<std::string> beyond_limits(const JointVec& q) const;
  /// May be called from several threads, which then take turns.
  [[nodiscard]] MoveMeasures measure(const IkSolver& ik, const std::vector<JointVec>& way) const;
  /// One line about the pair where something overlaps.
  [[nodiscard]] static std::optional<std::string> touches(const MoveMeasures& measures);
  [[nodiscard]] const ClearanceCheck& clearance() const { return clearance_; }

 private:
  Arm arm_;
  ClearanceCheck clearance_, shown_;
  std::shared_ptr<std::mutex> measuring_ = std::make_shared<std::mutex>();  ///< with `shown_`
};

}  // namespace mjarm::program
