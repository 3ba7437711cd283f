#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/collision/exact_grasp.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/program/answer_choice_internal.hpp"
#include "mjarm/program/detour_planner_internal.hpp"
#include "mjarm/program/move_measures_internal.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program::detail {

/// Where the arm stands, and in which of the scenes.
struct Stand {
  JointVec q;             ///< [rad or m] (dof,)
  std::size_t scene = 0;  ///< of Workplaces
  bool passes = false;    ///< it need not stop there where a straight move follows
};

/// What can be asked of one tool while the scene stands as it does.
struct Tool {
  Arm arm;
  IkSolver reach;  ///< geometry alone
  IkSolver ik;     ///< without contact
  MoveJudge judge;
  DetourPlanner detours;
  AnswerChoice answers;
  bool gripped =
      false;  ///< the gripper was used before: things may lie on things, or in its fingers
};

/// The scenes of a program: how things stand at first, and after each time the gripper closed or
/// opened; and the tools in each of them, made when they are asked for.
class Workplaces {
 public:
  /// @param arms       the arm with each tool, at least one; outlive this.
  /// @param options    of the program; outlive this.
  Workplaces(const Model& model, const std::vector<Arm>& arms, const ProgramPlanOptions& options)
      : model_(model), arms_(arms), options_(options), scenes_{options.scene} {}

  [[nodiscard]] const Model& model() const { return model_; }
  /// What may touch all through the program.
  [[nodiscard]] const std::vector<std::array<std::string, 2>>& allowed() const {
    return options_.allowed;
  }
  /// Stays what it is as long as somebody has it.
  [[nodiscard]] std::shared_ptr<Tool> tool(std::size_t scene, std::size_t tool);
  /// The scene after the gripper has closed or opened where the arm stands.
  /// @return an error where the arm has no gripper.
  [[nodiscard]] Result<std::size_t> gripped(const Stand& at, bool close);
  /// The scene in which things stand like that.
  [[nodiscard]] std::size_t enter(SceneState scene);
  [[nodiscard]] const SceneState& state(std::size_t scene) const { return scenes_[scene]; }
  /// What the arm carries, in the frame of the first tool.
  [[nodiscard]] const std::vector<AttachedBody>& attached(std::size_t scene) const {
    return scenes_[scene].attached;
  }

 private:
  [[nodiscard]] std::shared_ptr<Tool> make(const SceneState& scene, const Arm& arm) const;

  const Model& model_;
  const std::vector<Arm>& arms_;
  const ProgramPlanOptions& options_;
  std::vector<SceneState> scenes_;            ///< the first is how things stand at first
  std::map<std::string, std::size_t> known_;  ///< indices of `scenes_` by all that is in them
  std::deque<std::pair<std::pair<std::size_t, std::size_t>, std::shared_ptr<Tool>>> tools_;
};

}  // namespace mjarm::program::detail
