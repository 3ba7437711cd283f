#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/model/find_arm.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program::detail {

/// One thing to be done, with all that holds at that moment; repeats are unrolled.
struct Step {
  enum class Kind { joints, pose, line, arc, curve, wait, grip, plan, excite, look, pick, place };

  Kind kind = Kind::wait;
  std::string_view word;
  FilePlace place;
  std::size_t tool = 0;  ///< index of the arm with that tool
  double speed = 0;      ///< [m/s]
  bool keep_speed = false;
  double share = 1;
  Payload payload = {};             ///< at the first tool
  JointVec q = {};                  ///< joints
  Pose X_WT = {};                   ///< pose, line, arc: where it ends
  Pose X_via = {};                  ///< arc
  bool whole = false;               ///< arc
  double blend = 0;                 ///< [m] line, arc: of the corner at its end; curve: of all
  std::optional<Curve> curve = {};  ///< curve
  std::vector<Pose> points = {};    ///< curve: its corners X_WT, where it is straight between
  Branch branch = {};               ///< pose, curve, plan: of the answer that is chosen
  /// pose, curve, plan: nobody gave joint values from which the nearest answer would be meant.
  bool is_free = false;
  std::optional<ToolPress> press = {};          ///< curve
  std::optional<Eigen::Vector3d> right_W = {};  ///< of a text: the way it is read
  double seconds = 0;                           ///< wait, excite
  std::uint64_t seed = 1;                       ///< excite
  std::optional<double> clearance = {};         ///< [m] plan: what is asked
  bool close = false;                           ///< grip
  std::string object = {};                      ///< pick; look: the camera
  bool any_turn = false;                        ///< place; its X_WT is that of the object's body
};

struct Steps {
  std::vector<Arm> arms;  ///< by tool; the first is that of the beginning
  std::vector<Step> steps;
  JointVec q_start;  ///< where the arm stands at first
  std::vector<ProgramFault> faults;
};

/// Adds a fault; one of each place and reason, however often the place is repeated.
void add_fault(std::vector<ProgramFault>& faults, ProgramFault fault);

/// Resolves frames, tools and settings of every instruction in the order in which they run.
[[nodiscard]] Steps steps_of(const Program& program, const Model& model, const Arm& arm);

}  // namespace mjarm::program::detail
