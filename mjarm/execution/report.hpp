#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/metrics.hpp"
#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/execution/object_watch.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/sim/stepper.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace mjarm {

/// An error at rest, of several that are compared.
struct NamedError {
  std::string name;  ///< of what it belongs to, such as a way of control
  PoseError error;
};

/// A stretch on which the tool is slower than asked, and the name of the joint that holds it back.
struct ReportedDip {
  SpeedDip dip;
  std::string joint;
};

/// A figure, a word or some figures by name that not every run has.
struct Fact {
  std::string name;  ///< its key in report.json
  std::variant<double, std::string, std::map<std::string, double>> value;
};

/// One motion of a plan.
struct ReportedMove {
  int line = 0;  ///< of the program, 0 = of none
  std::string word;
  double duration = 0;  ///< [s] as planned
  /// [s] of a way round obstacles: what it would take to stop at every corner.
  std::optional<double> stopping;
  std::optional<PathError> path_error;  ///< against its curve, where it has one
};

/// What a motion did; becomes `report.json`. Optional parts are left out where they make no sense.
struct Report {
  std::string name;     ///< of what was run
  std::string model;    ///< model name inside the file
  bool ok = false;      ///< everything asked for was done within its tolerance
  std::string reason;   ///< word of the reason where not ok, e.g. "inner_void"
  std::string detail;   ///< one line for people where not ok
  std::string control;  ///< control mode used
  double duration = 0;  ///< [s] simulated time from start to end
  long steps = 0;       ///< simulation steps
  /// What was done of what was asked for, 0 to 1: of the path's length, of the waypoints, of the
  /// goals; `coverage` in the file.
  double done = 0;
  double max_joint_step = 0;  ///< [rad or m] largest joint step between neighbouring waypoints
  std::optional<PathError> path_error;    ///< against the ideal curve
  std::optional<PoseError> static_error;  ///< at rest at the goal
  std::vector<NamedError> static_errors;  ///< the same of all that are compared
  double velocity_use = 0;               ///< largest share of a joint velocity limit used, measured
  double torque_use = 0;                 ///< largest share of an actuator force limit used
  long saturated_steps = 0;              ///< steps in which a ctrl or force limit cut the command
  std::string first_contact;             ///< "geom a - geom b at t s"; empty where nothing touched
  std::optional<double> tool_speed_max;  ///< [m/s] measured
  std::vector<ReportedDip> speed_dips;   ///< of the planned tool motions, in order
  std::optional<double> min_manipulability;  ///< along them, see manipulability() [mixed units]
  std::optional<double> min_singular_value;  ///< along them [mixed units]
  std::vector<std::size_t> unreachable;      ///< indices of the poses that cannot be reached
  std::optional<Eigen::Vector3d> shift;      ///< [m] shift of the path that was verified to mend it
  std::vector<ReportedMove> moves;           ///< of a plan, in order
  std::vector<ObservedObject> objects;  ///< of the scene, that were carried or are not in place
  std::vector<HeldState> held;          ///< joints that are not the arm's, in the model's order
  std::vector<Fact> facts;              ///< what this run alone has to tell
  std::optional<double> rtf;  ///< simulated seconds a wall-clock second, without rendering
};

/// Adds what was planned: dips of the tool speed, how near it comes to singularities, the largest
/// joint step where that is larger than the one known.
void add_motion(const ToolMotion& motion, const Arm& arm, Report& report);

/// The same of one motion of a program; joint moves and rests have only their joint steps.
void add_motion(const PlannedMove& move, const Arm& arm, Report& report);

/// Puts in how long it took, what limits were used and what touched first.
void put_outcome(const FollowOutcome& total, Report& report);

/// `report` as one JSON document, keys in fixed order, full double precision, newline at the end.
[[nodiscard]] std::string to_json(const Report& report);

}  // namespace mjarm
