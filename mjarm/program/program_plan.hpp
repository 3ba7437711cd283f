#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/collision/exact.hpp"
#include "mjarm/kinematics/singularity.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/program/program.hpp"
#include "mjarm/program/tool_speed.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// Loads scene and robot of a program.
/// @param file  of the program: relative paths in it start from its folder. Messages name it.
[[nodiscard]] Result<Robot> load_program_robot(const Program& program,
                                                      const std::filesystem::path& file);

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

/// A tool pose that a motion was given.
struct PlannedPoint {
  Pose X_WT;
  FilePlace place;  ///< of the instruction that goes there
};

/// One motion of a plan: an instruction, or several that are blended into one.
struct PlannedMove {
  /// Of the instruction; "approach": to where a curve begins. Of blended ones each word once, as in
  /// "movel+movec".
  std::string word;
  FilePlace place;               ///< of the first instruction
  std::size_t instructions = 1;  ///< how many it does
  std::size_t tool = 0;          ///< index in ProgramPlan::arms
  Trajectory trajectory;         ///< a rest where nothing moves
  std::optional<Curve> curve;    ///< of the tool in the world; none for joint moves and rests
  /// What `curve` was made from: where it starts, and the corners of straight moves (see
  /// Curve::blends()) or the two poses of one arc; empty where arcs are blended and for curves that
  /// have a center.
  std::vector<PlannedPoint> points;
  /// Of a detour (`plan`): the joint values that its edges run between, start and goal
  /// included. Every edge is proved free of contact; the trajectory cuts the corners where that is
  /// as well.
  std::vector<JointVec> corners;
  std::optional<bool> close;             ///< the gripper closes or opens
  std::vector<SpeedDip> dips;            ///< where the tool is slower than asked
  std::optional<MoveMeasures> measures;  ///< none for rests

  [[nodiscard]] bool is_approach() const { return word == "approach"; }
};

/// What `plan` would do in the place of a move that something blocks: tried, and free of contact.
struct Detour {
  std::size_t edges = 0;  ///< straight in joint space
  double duration = 0;    ///< [s]
  double clearance = 0;   ///< [m] as in MoveMeasures
};

/// What cannot be done, and where it stands in the file.
struct ProgramFault {
  FilePlace place;
  std::string word;  ///< of the instruction
  std::string
      reason;        ///< word: "out_of_reach", "joint_limit", "blend_overlap", "unknown_name", ...
  std::string what;  ///< one line for people, without the place
  Errc code = Errc::impossible;
  std::optional<Detour> detour = {};  ///< of a blocked movej or movel, where there is one
};

/// A program that was thought through, before anything moves.
struct ProgramPlan {
  std::vector<Arm> arms;             ///< the arm with each tool that is used
  JointVec q_start;                  ///< where it begins: `start`, else the arm's home
  std::vector<PlannedMove> moves;    ///< one after another; gaps where there are faults
  std::vector<ProgramFault> faults;  ///< in the order of the program; it may run where empty

  [[nodiscard]] bool ok() const noexcept { return faults.empty(); }
  [[nodiscard]] double duration() const;  ///< [s] of all moves
};

/// How to think a program through. Every default is usable as is.
struct ProgramPlanOptions {
  bool collision = true;     ///< look at contact, and measure clearance
  double tool_speed = 0.25;  ///< [m/s] where the program says none, > 0
  /// Called after every step with how many of how many are done; returns false to stop. May be
  /// empty.
  std::function<bool(std::size_t done, std::size_t total)> after_step = {};
};

/// Plans every motion of `program`: the arm begins at `start`; goals of `movej` get the answer from
/// which the straight moves that follow can be done; straight moves and curves the branch that goes
/// all the way (solve_path.hpp); `plan` goes round obstacles (plan_path.hpp) to whichever answer
/// the moves that follow can go on from; curves that begin elsewhere are approached by a joint
/// move. After a fault it goes on from where the faulty instruction should have ended, so that one
/// call finds all faults; of moves that something blocks they tell the detour that `plan` would
/// take. A speed that is asked for by name must be one the joints can keep.
[[nodiscard]] ProgramPlan plan_program(const Model& model, const Arm& arm, const Program& program,
                                       const ProgramPlanOptions& options = {});

}  // namespace mjarm
