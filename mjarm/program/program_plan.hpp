#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "mjarm/collision/exact_grasp.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/program/program.hpp"

namespace mjarm::program {

/// Loads scene and robot of a program.
/// @param file  of the program: relative paths in it start from its folder; what is not there may
///              be a shipped model. Messages name it.
/// @param load  how the robot's files are read.
[[nodiscard]] Result<Robot> load_program_robot(const Program& program,
                                               const std::filesystem::path& file,
                                               const LoadOptions& load = {});

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
  std::optional<PathFix> fix = {};    ///< of a tool move: a change with which all of it was solved
};

/// A program that was thought through, before anything moves: its motions, with gaps where there
/// are faults. It begins at the program's `start`, else at the arm's home.
struct ProgramPlan : MotionPlan {
  std::vector<ProgramFault> faults;  ///< in the order of the program; it may run where empty
  SceneState scene_end = {};         ///< how things will stand then; empty: as in the model

  [[nodiscard]] bool ok() const noexcept { return faults.empty(); }
};

/// The same; a fault names its place in the file by itself.
[[nodiscard]] Result<Robot, ProgramFault> load_robot_of(const Program& program,
                                                        const std::filesystem::path& file,
                                                        const LoadOptions& load = {});

/// The names, units and numbers of values of `program` that do not fit the robot, in the order of
/// the program; nothing is planned.
[[nodiscard]] std::vector<ProgramFault> find_misfits(const Model& model, const Arm& arm,
                                                     const Program& program);

/// How a camera saw a scene.
struct SeenScene {
  SceneState scene = {};                        ///< what was seen stands where it was seen
  std::map<std::string, std::string> unseen{};  ///< objects without a pose, and why
  std::set<std::string> anywhere{};             ///< those of `unseen` of which nothing is known
  /// Of objects whose pose is known up to their symmetry alone: PlaceGoal::same.
  std::map<std::string, std::vector<Pose>> same{};
};
/// Looks at a scene with a camera of the model: session/see_scene.hpp has one.
/// @param scene  how things stand; what cannot be seen is taken from it.
/// @param q      (dof,) [rad or m] where the arm stands.
using SeeScene =
    std::function<Result<SeenScene>(const Robot& robot, const std::string& camera,
                                    const SceneState& scene, std::span<const double> q)>;

/// How to think a program through. Every default is usable as is.
struct ProgramPlanOptions {
  bool collision = true;     ///< look at contact, and measure clearance
  double tool_speed = 0.25;  ///< [m/s] where the program says none, > 0
  SceneState scene = {};     ///< how things stand at first; empty: as in the model
  /// Two names each, of bodies or geoms, that may touch and overlap all through the program, as
  /// ContactRules has them: fingers and the handle they pull.
  std::vector<std::array<std::string, 2>> allowed = {};
  /// Nothing behind the first fault is planned, nor looked for what would mend it.
  bool to_first_fault = false;
  SeeScene see = {};  ///< does the instruction `look`, which is a fault without
  /// Called after every step with how many of how many are done. May be empty.
  std::function<void(std::size_t done, std::size_t total)> after_step = {};
  StopCheck stop = {};  ///< ends the work; the plan then has a fault `stopped`
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

}  // namespace mjarm::program
