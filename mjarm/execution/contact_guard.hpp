#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/control/contact_observer.hpp"
#include "mjarm/control/contact_place.hpp"
#include "mjarm/control/controller.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/motion_clock.hpp"
#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// What an arm does about a contact that nobody planned, as far as its joints notice it.
enum class ContactReaction {
  ignore,  ///< nobody looks
  stop,    ///< it stops within its limits, backs off, and the run ends
};
/// "ignore" or "stop".
[[nodiscard]] std::string_view name(ContactReaction reaction) noexcept;
/// The reaction of that name, or an error with the nearest one.
[[nodiscard]] Result<ContactReaction> contact_reaction(std::string_view name);

/// A contact that joints noticed.
struct FeltContact {
  double time = 0;        ///< [s] of the simulation, when it was noticed
  int joint = -1;         ///< the last joint that moves what is touched
  std::string link = {};  ///< the body that is touched (ContactPlaces)
  double force = 0;       ///< [N] about: of what explains the torques the likeliest
  JointVec torque;        ///< (dof,) [N m or N] on the joints
};

/// Has an arm stop and back off where its joints feel what no plan knows (ContactObserver): down to
/// rest along its path, as fast as its limits allow, then kBackOff of the tool's way back. While
/// the gripper closes or opens, and in the motion after that, in which a load is lifted or put
/// down, nobody looks; nor while a tool presses.
class ContactGuard {
 public:
  static constexpr double kBackOff = 0.03;  ///< [m]

  [[nodiscard]] static Result<ContactGuard> create(const Model& model, const Arm& arm);

  /// The arm has another load from now on.
  void change_model(const Model& model);
  /// Before the command of a step.
  /// @param planned  what the joints feel now is planned.
  /// @return true in the step in which a contact is noticed for the first time.
  bool look(const Sim& sim, bool planned);
  /// After it.
  void take(const JointVec& torque) { observer_.take(torque); }
  /// Where the arm, at rest, goes instead of the plan; none where it has backed off.
  [[nodiscard]] std::optional<StepReference> back_off(const MotionPlan& plan,
                                                      const MotionClock& clock);
  /// What was noticed; it tells link and force as the 14 ms after that know them.
  [[nodiscard]] const std::optional<FeltContact>& contact() const noexcept { return contact_; }
  void restart();

 private:
  ContactGuard(const Model& model, const Arm& arm, ContactObserver observer);
  void judge(const NoticedContact& noticed, const JointVec& q, double time);
  void plan_way_back(const MotionPlan& plan, const MotionClock& clock);

  Model model_;
  Arm arm_;
  ContactObserver observer_;
  ContactPlaces places_;
  std::optional<FeltContact> contact_;
  double surprise_ = 0;         ///< of `contact_`
  bool planned_ = false;        ///< in the last step
  std::vector<JointVec> back_;  ///< positions of the way back, step by step
  std::size_t done_ = 0;
  bool has_way_ = false;
};

}  // namespace mjarm
