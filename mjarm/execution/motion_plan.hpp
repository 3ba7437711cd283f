#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/file_place.hpp"
#include "mjarm/kinematics/singularity.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/payload.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/trajectory/tool_speed.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// How near a motion comes to what it should keep away from.
struct MoveMeasures {
  Singularity singularity;    ///< where the smallest singular value is least
  double limit_room = 0;      ///< [rad or m] from the nearest limit; infinite where there is none
  int limit_joint = -1;       ///< whose that is
  double clearance = 0;       ///< [m] infinite beyond the margin of the checker
  GeomPair nearest;           ///< what is that near
  double max_step = 0;        ///< [rad or m] largest step of a joint between waypoints
  double manipulability = 0;  ///< the least, see manipulability()
};

/// A tool that presses on something along its own z axis all through a motion: a pen on paper. The
/// motion itself is that of the tool above it; see Presser.
struct ToolPress {
  double force = 1;     ///< [N] > 0
  double reach = 0.04;  ///< [m] > 0 that the tool goes along z at most until it meets something
};

/// A tool pose that a motion was given.
struct PlannedPoint {
  Pose X_WT;
  FilePlace place;  ///< of the instruction that goes there
};

/// One motion of a plan: an instruction, or several that are blended into one.
struct PlannedMove {
  /// Of the instruction; "approach": to where a curve begins. Of blended ones each word once, as in
  /// "movel+movec".
  std::string word = {};
  FilePlace place = {};             ///< of the first instruction
  std::size_t instructions = 1;     ///< how many it does
  std::size_t tool = 0;             ///< index in MotionPlan::arms
  Trajectory trajectory = {};       ///< a rest where nothing moves
  std::optional<Curve> curve = {};  ///< of the tool in the world; none for joint moves and rests
  /// What `curve` was made from: where it starts, and the corners of straight moves (see
  /// Curve::blends()) or the two poses of one arc; empty where arcs are blended and for curves that
  /// have a center.
  std::vector<PlannedPoint> points = {};
  /// Of a way round obstacles: the joint values that its edges run between, start and goal
  /// included. Every edge is proved free of contact; the trajectory leaves them where that is as
  /// well.
  std::vector<JointVec> corners = {};
  std::vector<std::size_t> passed = {};  ///< of `corners`, by index: goals that are met on the way
  std::optional<double> stopping = {};   ///< [s] what it would take to stop at every corner
  bool passes = false;                   ///< ends moving, as the next one begins: no stop
  std::optional<ToolPress> press = {};   ///< needs tool_impedance and a force sensor
  std::optional<Eigen::Vector3d> right_W = {};  ///< of a text: the way it is read, a unit vector
  std::optional<bool> close = {};               ///< the gripper closes or opens at its beginning
  std::vector<AttachedBody> attached = {};      ///< to the first arm's tool, at its end
  /// Two names each, of bodies or geoms, that may touch in it, as ContactRules has them.
  std::vector<std::array<std::string, 2>> allowed = {};
  /// Hangs at the first arm's tool while it moves, beside what is attached: the controller knows
  /// it, and the simulation has it.
  Payload payload = {};
  std::vector<SpeedDip> dips = {};            ///< where the tool is slower than asked
  std::optional<MoveMeasures> measures = {};  ///< none for rests

  [[nodiscard]] bool is_approach() const { return word == "approach"; }
};

/// What a motion is for whoever looks at the tool: on its way to where a curve begins; a joint move
/// between the curves of a plan, or any between those that press, as with a pen that is lifted; or
/// what the plan is about.
enum class MotionPart { approach, travel, work };

/// Motions that follow each other, from rest to rest but where one passes into the next: what an
/// Execution executes.
struct MotionPlan {
  std::vector<Arm> arms;           ///< the arm with each tool that is used, at least one
  JointVec q_start;                ///< [rad or m] (dof,) where it begins
  std::vector<PlannedMove> moves;  ///< one after another

  /// One trajectory, as a plan.
  [[nodiscard]] static MotionPlan of(const Arm& arm, Trajectory trajectory);
  [[nodiscard]] double duration() const;  ///< [s] of all moves
  [[nodiscard]] JointVec q_end() const;   ///< [rad or m] (dof,) where it ends
  [[nodiscard]] bool presses() const;     ///< one of the motions does: PlannedMove::press
  /// Of the motion with that index.
  [[nodiscard]] MotionPart part(std::size_t move) const;
};

/// Where the tool goes in a motion; fewer than two poses where it rests.
[[nodiscard]] std::vector<Pose> planned_tool_path(const PlannedMove& move, const Arm& arm);

}  // namespace mjarm
