#pragma once

#include <string>
#include <vector>

#include "mjarm/core/joint_state.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/trajectory/path_timing.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm {

/// What a motion in time can be asked for.
enum class TimeProblem {
  p2p,       ///< from one state to another: v, a and jerk limits
  path_va,   ///< along one given path: v and a limits
  path_vaj,  ///< the same with jerk limits
  via_vaj,   ///< through waypoints, the shape free: v, a and jerk limits
};

inline constexpr TimeProblem kTimeProblems[] = {TimeProblem::p2p, TimeProblem::path_va,
                                                TimeProblem::path_vaj, TimeProblem::via_vaj};
/// The problem as a word, such as `path_va`.
[[nodiscard]] const char* name(TimeProblem problem) noexcept;

/// One motion to be found.
struct TimeCase {
  std::string id;                   ///< as a JSON key; empty for a request of the command line
  JointState start, end;            ///< p2p
  std::vector<JointVec> waypoints;  ///< the others
};

/// Cases with the limits that go for all of them.
struct TimeCases {
  JointLimits limits;  ///< position limits infinite
  std::vector<TimeCase> cases;
};

/// Reads `content`, the text of a file of cases, which is a JSON object:
/// `{"limits":{"v":[],"a":[],"j":[]},"cases":[{"id":...,"q0":[],"q1":[]},...]}` (p2p; maybe with
/// v0, a0, v1, a1), `{"id":...,"waypoints":[[],...]}` (the others). [rad or m, s] @return an error
/// that names the case and the entry.
[[nodiscard]] Result<TimeCases> read_time_cases(const std::string& content, TimeProblem problem);

/// Limits without an end of the joints' range.
[[nodiscard]] JointLimits unbounded(const JointVec& v, const JointVec& a, const JointVec& j);

/// Finds the motion.
/// @param torque  torque limits for paths; its jerk limits follow from the problem.
[[nodiscard]] Result<Trajectory> time_case(const TimeCase& entry, const JointLimits& limits,
                                           TimeProblem problem, PathTimingOptions torque = {});

}  // namespace mjarm
