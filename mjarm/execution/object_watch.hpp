#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/sim/stepper.hpp"

namespace mjarm {

/// [m] and [rad] so far an object may be from where the plan has it: where it stood, and of one
/// that is carried in the gripper, where it swings and slips a little, and where it was put down.
inline constexpr double kObjectPosition = 0.01, kObjectRotation = 0.2;
inline constexpr double kCarriedPosition = 0.02, kCarriedRotation = 0.35;

/// What is wrong with an object after a plan was executed.
enum class ObjectFault {
  none,
  lost,     ///< it is not in the gripper where the plan has it, nor where it was to be left
  moved,    ///< the arm, or what it moved, pushed it away
  touched,  ///< the arm touched it, or it touched something while it was carried
};
/// "object_lost", "object_moved", "object_touched"; empty for none.
[[nodiscard]] std::string_view name(ObjectFault fault) noexcept;

/// What became of one object (a free body of the scene) in the execution of a plan.
struct ObservedObject {
  std::string name;
  bool carried = false;      ///< the plan has it in the gripper at some time
  double moved = 0;          ///< [m] from where it was at the beginning
  double off_plan = 0;       ///< [m] at most, from where the plan has it
  double turned = 0;         ///< [rad] at most, from how the plan has it
  bool fell = false;         ///< it came to be more than 20 mm lower than the plan has it
  std::optional<double> at;  ///< [s] when it was off by more than may be
  std::string touched;       ///< what it touched first that the plan does not know; may be empty
  double touched_at = 0;     ///< [s]
  bool by_itself = false;    ///< it moved, and nothing that the arm moved had touched it
  ObjectFault fault = ObjectFault::none;
};
/// One line for people about an object with a fault.
[[nodiscard]] std::string describe(const ObservedObject& object);

/// Looks at the objects of a scene, and at what touches, while a plan is executed. What may touch:
/// the hand itself and what it carries, before, while and after it does; what an object stands on
/// when it is picked up and put down; what a motion allows (PlannedMove::allowed). Knows no physics
/// but what the simulation shows.
class ObjectWatch {
 public:
  /// @param plan  outlives this.
  ObjectWatch(const Model& model, const MotionPlan& plan);

  /// Forgets what was seen.
  void restart();
  /// After each step of motion `move`, and in the end with the number of all motions.
  /// @param presses  the tool presses on something, as it should.
  void look(const Sim& sim, std::size_t move, bool presses = false);

  /// The first contact of the arm, or of what it carries, that the plan does not know.
  [[nodiscard]] const std::optional<TimedContact>& first_contact() const { return first_contact_; }
  /// All objects that are carried, were touched or are not where they were to be.
  [[nodiscard]] std::vector<ObservedObject> objects() const;

 private:
  /// What is known of one object.
  struct Track {
    std::vector<const AttachedBody*> attached;  ///< per move of the plan: in the gripper at its end
    Pose X_WB_first;                            ///< at the beginning
    Pose X_WB_plan;                             ///< where it stands, where it is not carried
    /// How it truly stands in the plan's frame of it when it is first picked up: whoever planned
    /// may know it up to its symmetry alone.
    std::optional<Eigen::Matrix3d> R_plan_true;
    std::set<std::string> rests_on;         ///< touched while it was not carried
    std::map<std::string, double> touched;  ///< while it was carried, and when first [s]
    bool disturbed = false;                 ///< by the arm, or by what that disturbed
    ObservedObject seen;
  };
  /// What the plan has of an object before a moment and from then on.
  struct Turn {
    const AttachedBody* before = nullptr;
    const AttachedBody* now = nullptr;
    [[nodiscard]] bool is_in_hand() const { return before != nullptr && now != nullptr; }
  };
  [[nodiscard]] static Turn turn_at(const Track& track, std::size_t move);
  void compare(const Sim& sim, std::size_t move, std::size_t object);
  void note_object(std::size_t object, int other_body, const std::string& other, double time,
                   std::size_t move);
  [[nodiscard]] bool is_planned(const Contact& contact, std::size_t move, bool presses) const;
  [[nodiscard]] bool is_allowed(const Contact& contact, std::size_t move) const;

  const MotionPlan* plan_;
  SceneBodies bodies_;
  std::vector<Eigen::Vector3d> centers_;  ///< [m] of mass, per object, which no symmetry moves
  std::vector<Track> tracks_;             ///< per object
  std::optional<TimedContact> first_contact_;
  bool begun_ = false;
};

}  // namespace mjarm
