#pragma once

#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/file_place.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/execution/contact_guard.hpp"
#include "mjarm/kinematics/branch.hpp"
#include "mjarm/model/payload.hpp"

namespace mjarm::program {

/// The name of a frame of the program or of the model; empty = the frame that is set then.
struct FrameName {
  std::string name = {};
  FilePlace place = {};
};

/// A tool pose as a program gives it.
struct ProgramPose {
  Pose X_FT = {};        ///< the tool in `frame`
  FrameName frame = {};  ///< F
};

/// Joint values as a program gives them, (dof,); none: home.
struct JointValues {
  std::vector<double> values = {};  ///< [rad or m]
  /// What the unit of each measures, `number` where it has none; no entries: they are all in rad or
  /// m, whatever their size.
  std::vector<Quantity> units = {};
};

/// Straight in joint space, to joint values or to a tool pose; the answer to the pose is chosen so
/// that what follows can be done from there.
struct MoveJ {
  std::variant<JointValues, ProgramPose> goal;
  std::optional<double> share = {};   ///< of the joints' limits, (0, 1]
  std::optional<Branch> branch = {};  ///< of the answer to a pose
};

/// The tool in a straight line to `goal`.
struct MoveL {
  ProgramPose goal;
  std::optional<double> speed = {};  ///< [m/s] > 0
  std::optional<double> blend = {};  ///< [m] >= 0: the corner at `goal` is cut within it
};

/// The tool on an arc of a circle through `via` to `to`; all the way round where `whole`.
struct MoveC {
  ProgramPose via, to;
  std::optional<double> speed = {};
  std::optional<double> blend =
      {};  ///< [m] >= 0: the corner at `to` is cut within it; not of whole
  bool whole = false;
};

/// One lap of an ellipse, `word` "ellipse" or "circle"; see Ellipse for where it begins.
struct DrawEllipse {
  std::string word = "ellipse";
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m] in `frame`
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< in `frame`, any length but zero
  double a = 0.1, b = 0.1;                            ///< [m] semi-axes, > 0
  Eigen::Matrix3d R_FT = Eigen::Matrix3d::Identity();
  FrameName frame = {};
  std::optional<double> speed = {};
};

/// Straight from point to point, at least two.
struct DrawPolyline {
  std::vector<ProgramPose> points;
  std::optional<double> speed = {};
  std::optional<double> blend = {};  ///< [m] >= 0 of every corner
};

/// A smooth curve through points, at least two: Curve::spline().
struct DrawSpline {
  std::vector<ProgramPose> points;
  double corner =
      std::numbers::pi;  ///< [rad] > 0: where it turns by more from chord to chord it has a corner
  std::optional<double> speed = {};
};

/// Strokes of letters and Chinese characters; between them the tool is lifted against its own z
/// axis.
struct DrawText {
  std::string text;
  double height = 0.1;  ///< [m] of a letter, > 0
  double lift = 0.02;   ///< [m] > 0
  /// [N] > 0: the tool moves `lift` above the plane and is pressed on what lies under it, stroke by
  /// stroke (ToolPress).
  std::optional<double> press = {};
  /// The plane: x to the right, y up, the first letter begins at its origin.
  ProgramPose plane = {};
  Eigen::Matrix3d R_FT = Eigen::Matrix3d::Identity();  ///< of the tool, in the plane's frame
  std::optional<double> speed = {};
};

/// The arm stands still.
struct Wait {
  double seconds = 0;  ///< [s] >= 0
};

/// Holds for all that follows.
struct Set {
  std::optional<std::string> tool = {};
  std::optional<FrameName> frame = {};
  std::optional<double> speed = {};  ///< [m/s] of tool moves, > 0
  std::optional<double> share = {};  ///< of the joint limits in joint moves, (0, 1]
  std::optional<double> zone = {};  ///< [m] >= 0, `blend` of straight moves and arcs that have none
  std::optional<Branch> branch = {};    ///< wherever the answer to a pose is free
  std::optional<Payload> payload = {};  ///< hangs at the tool from then on; mass 0: nothing does
};

/// Round obstacles, by the planner.
struct PlanMove {
  std::variant<JointValues, ProgramPose> goal;
  std::optional<Branch> branch = {};  ///< of the answer to a pose
  /// [m] >= 0: kept from all else on the way, as PlanOptions::clearance has it.
  std::optional<double> clearance = {};
};

/// Every joint to and fro about where it stands, so that a log of it tells payload, friction and
/// links (excitation()).
struct Excite {
  double seconds = 20;  ///< [s] 5 .. 120
  std::uint64_t seed = 1;
};

/// The gripper closes or opens where the arm stands.
struct Grip {
  bool close = true;
};

/// A camera of the scene looks where the objects are, before anything moves.
struct Look {
  std::string camera;
  FilePlace place = {};
};

/// An object is picked up. Where `place` is the next instruction the grasp is one that suits it.
struct Pick {
  std::string object;  ///< a body with a free joint
  FilePlace place = {};
};

/// What the gripper holds is put down.
struct Place {
  ProgramPose goal;       ///< of the object's body
  bool any_turn = false;  ///< it may be turned about the world's vertical
};

struct Instruction;

/// Instructions that are run several times.
struct Repeat {
  int times = 1;  ///< >= 0
  std::vector<Instruction> body;
};

/// One sentence of a program.
struct Instruction {
  using What = std::variant<MoveJ, MoveL, MoveC, DrawEllipse, DrawPolyline, DrawSpline, DrawText,
                            Wait, Set, PlanMove, Excite, Grip, Look, Pick, Place, Repeat>;
  What what;
  FilePlace place = {};
};

/// The word of an instruction in program files: "movej", "movel", "ellipse", ...
[[nodiscard]] std::string_view word(const Instruction& instruction) noexcept;

/// A motion program: what shall be done, and with what; a plain value. Nothing of it was tried.
struct Program {
  std::string name;   ///< of the file, without folder and extension
  std::string robot;  ///< name of a shipped robot, or the path of a file; empty = that of `scene`
  std::string scene;  ///< path of a file that holds the robot; empty = the robot's own
  std::string tool;   ///< frame of the robot that is moved; empty = the robot's own
  FilePlace robot_place, scene_place, tool_place;
  JointValues start;  ///< where the arm stands at first
  FilePlace start_place;
  std::map<std::string, ProgramPose> frames;  ///< by name, each in another one or in the world
  Set settings = {};                          ///< what holds before the first instruction
  std::optional<ControlMode> control = {};
  std::optional<ContactReaction> contact = {};  ///< to what the joints feel
  std::vector<Instruction> instructions;
};

/// The same sentences as calls, for programs written in C++; poses are in the frame that is set.
[[nodiscard]] Instruction move_j(std::vector<double> q, std::optional<double> share = {});
[[nodiscard]] Instruction move_j(const Pose& X_FT, std::optional<double> share = {});
[[nodiscard]] Instruction move_l(const Pose& X_FT, std::optional<double> speed = {},
                                 std::optional<double> blend = {});
[[nodiscard]] Instruction move_c(const Pose& X_via, const Pose& X_to,
                                 std::optional<double> speed = {},
                                 std::optional<double> blend = {});
[[nodiscard]] Instruction wait(double seconds);
[[nodiscard]] Instruction repeat(int times, std::vector<Instruction> body);

}  // namespace mjarm::program
