#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/stop.hpp"
#include "mjarm/episode/task_internal.hpp"

namespace mjarm::episode {

/// X_TJ of a frame between the fingers: x to the side, y the way they close, z the way they come up
/// to things.
[[nodiscard]] Pose jaws_pose(const Jaws& jaws);

/// A tool that goes round what is in the way, straight, and a gripper that closes or opens.
[[nodiscard]] program::Instruction plan_to(const Pose& X_WT);
[[nodiscard]] program::Instruction line_to(const Pose& X_WT, double speed);
[[nodiscard]] program::Instruction grip(bool close);

/// A plan that is made piece by piece, each in a scene and with contacts of its own.
class PlanChain {
 public:
  using Allowed = std::vector<std::array<std::string, 2>>;

  /// @param input  outlives this.
  PlanChain(const PlanInput& input, std::span<const double> q);

  /// Plans what comes next; nothing where an earlier piece failed.
  /// @return whether all went well so far.
  bool add(std::vector<program::Instruction> instructions, Allowed allowed = {});
  /// What was planned elsewhere from q() and scene() on.
  void append(program::ProgramPlan piece);
  /// The same, the tool pressed on something all through it.
  void append(PlanChain piece, const ToolPress& press);
  /// How things stand now; what the arm moved otherwise than by carrying is the caller's to tell.
  [[nodiscard]] SceneState& scene() { return scene_; }
  [[nodiscard]] JointVec q() const { return joint_vec(q_); }
  [[nodiscard]] const program::ProgramPlan& plan() const { return plan_; }
  /// Ends it: there is none for this reason.
  void refuse(std::string reason) {
    if (reason_.empty()) reason_ = std::move(reason);
  }
  [[nodiscard]] TaskPlan finish(const Pose& goal) &&;

 private:
  const PlanInput* input_;
  std::vector<double> q_;
  SceneState scene_;
  program::ProgramPlan plan_;
  std::string reason_;
};

}  // namespace mjarm::episode
