#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/program/pick_place.hpp"

// What speaks for and against the grasps of one object, before any way is planned.
namespace mjarm::program::detail {

/// A grasp that can be had, and where.
struct GoodGrasp {
  Grasp grasp = {};
  Pose X_WT = {};        ///< the tool when the fingers close
  Pose X_TB = {};        ///< the object then
  Pose X_WT_place = {};  ///< the tool when they open
  Pose X_WB_place = {};
  double cost = 0;  ///< [m] off the centre of mass, from aside, near to other things
};

/// Why a grasp will not do.
struct Drop {
  PickErrc code;
  std::string what;
};

/// Finds the grasps of one object that can be had where things stand.
class GraspChoice {
 public:
  /// @param scene  how things stand; empty: as in the model.
  /// @param q      (dof,) [rad or m] where the arm stands. Robot, q and options must outlive this.
  GraspChoice(const Robot& robot, const SceneState& scene, std::span<const double> q, PickTask task,
              const PickOptions& options);

  /// Object, gripper, and how things stand with open fingers; before choose().
  Result<void, PickFailure> look();
  /// The grasps that can be had and put down with, the best first; none of those that were dropped.
  /// @param turns  GraspOptions::turns.
  std::vector<GoodGrasp> choose(int turns);
  /// The one by which `object`, which hangs on the tool, is put down.
  Result<GoodGrasp, Drop> in_hand(const AttachedBody& object);

  void drop(const Grasp& grasp, Drop why);
  [[nodiscard]] std::vector<DroppedGrasp>& dropped() { return dropped_; }
  [[nodiscard]] const SceneState& scene() const { return scene_; }
  [[nodiscard]] const PickTask& task() const { return task_; }
  /// The fingers are open already.
  [[nodiscard]] bool stands_open() const;
  /// [m] the tool drawn back from a grasp or a place, and lifted from it.
  [[nodiscard]] Pose back_from(const Pose& X_WT) const;
  [[nodiscard]] Pose above(const Pose& X_WT) const;

 private:
  void sort_bodies(const SceneBodies& bodies);
  [[nodiscard]] IkSolver solver(ExactChecker& checker) const;
  [[nodiscard]] ContactRules without_object() const;
  Result<JointVec, Drop> posture(const IkSolver& ik, const Pose& X_WT, ExactChecker& checker,
                                 bool holds) const;
  [[nodiscard]] bool is_of_hand(const GeomPair& pair, bool holds) const;
  Result<void, Drop> look_at(GoodGrasp& one, const IkSolver& ik, ExactChecker& checker);
  Result<void, Drop> look_at_closing(const SceneState& held, double& clear) const;
  Result<void, Drop> keep_off(ExactChecker& beside, double& clear) const;
  Result<void, Drop> look_at_place(GoodGrasp& one, const SceneState& held);

  const Robot& robot_;
  SceneState scene_;
  std::span<const double> q_;
  PickTask task_;
  const PickOptions& options_;
  IkSolver reach_;                               ///< geometry alone
  std::set<std::string> links_, hand_, object_;  ///< names of bodies
  std::vector<SceneObject> others_;              ///< objects that are not asked for
  Jaws jaws_;
  ObjectShape shape_;
  SceneState open_;  ///< with open fingers
  /// Open fingers, but not near to the object, which they are in any case; none in_hand().
  std::optional<ExactChecker> opened_;
  JointVec q_grasp_;
  std::vector<DroppedGrasp> dropped_;
};

}  // namespace mjarm::program::detail
