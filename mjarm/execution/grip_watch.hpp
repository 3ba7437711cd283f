#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/collision/exact_grasp.hpp"
#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// [m] and [rad] that a finger may close farther than what it holds lets it; of thin things half of
/// the way that is left.
inline constexpr double kFingerSlide = 2e-3, kFingerTurn = 0.03;
/// [rad or m] that a joint may be off the reference for so long [s]: of an arm that is free it is a
/// thousandth, but more for a moment where a servo's damping takes all of its range (the last joint
/// of a Panda that runs towards its limit).
inline constexpr double kBlockedError = 0.03, kBlockedTime = 0.2;

/// What can go wrong with what is carried.
enum class GripFault {
  none,
  nothing_held,  ///< the fingers closed on less than was to be between them
  lost,          ///< they held it, and closed farther on the way
  blocked,       ///< the arm does not get where it should be
};
/// "nothing_held", "lost", "blocked"; empty for none.
[[nodiscard]] std::string_view name(GripFault fault) noexcept;

/// Notices what goes wrong with a grasp while a plan is executed as a real arm can: by its fingers
/// and its joints alone. Where the objects are it does not see.
class GripWatch {
 public:
  /// @param plan    outlives this.
  /// @param before  how things stand at its beginning; empty: as in the model.
  GripWatch(const Model& model, const MotionPlan& plan, SceneState before);

  /// After each step of motion `move`.
  /// @param error  (dof,) [rad or m] of the arm's joints from their reference.
  /// @return what was noticed, from then on.
  GripFault look(const Sim& sim, std::size_t move, const JointVec& error);
  /// One line for people; empty where there is none.
  [[nodiscard]] const std::string& what() const { return what_; }

 private:
  /// A joint of the gripper.
  struct Finger {
    std::string name;
    std::size_t qpos = 0;
    bool slides = true;
    double closed = 0;  ///< [m or rad] where it stops
  };
  void find_fingers(const Model& model, const Arm& arm);
  [[nodiscard]] const Finger* closed_too_far(const Sim& sim, std::size_t move) const;

  const MotionPlan* plan_;
  std::vector<Finger> fingers_;
  /// By motion: the configuration (nq,) in which the fingers hold something; empty where they hold
  /// nothing.
  std::vector<std::vector<double>> holding_;
  double on_way_;       ///< [s] when all joints were last where they should be
  bool holds_ = false;  ///< something, when it was last looked at
  GripFault fault_ = GripFault::none;
  std::string what_;
};

}  // namespace mjarm
