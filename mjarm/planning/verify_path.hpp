#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/plan_file.hpp"
#include "mjarm/planning/problem_file.hpp"

namespace mjarm {

inline constexpr double kLeastVerifyStep = 1e-5;  ///< [rad or m, L2]
/// Samples along one path; longer ones are a fault of theirs.
inline constexpr double kMaxVerifySamples = 1e6;

/// How paths are judged.
struct VerifyRules {
  double step = 0.005;     ///< [rad or m, L2] spacing of MuJoCo's own check, >= kLeastVerifyStep
  double allow_depth = 0;  ///< [m] overlap that still counts as free, >= 0
  StopCheck stop = {};
};

/// What is wrong with a path.
struct PathFault {
  const char* kind;  ///< start, goal, limits, hit, undecided, length, contact, tilt, region, cost,
                     ///< certificate or clearance
  int edge = -1;     ///< from 0; -1: none in particular
  std::string what;  ///< one line
};

/// What was found out about a path.
struct PathVerdict {
  std::vector<PathFault> faults;                               ///< none: it is valid
  double clearance = std::numeric_limits<double>::infinity();  ///< [m] the least that was met, of
                                                               ///< what is hit at samples
  double cost = 0;                                             ///< [rad or m] sum of L2 lengths
};

/// Judges a path with at least one row: its ends, its limits and edges by verify_edge(), MuJoCo's
/// own collision detection on a model of the spheres, and what the file says of it. Of the edges
/// the first that is faulty counts. Edges that leave the limits, or are too long to be sampled, are
/// looked at no further.
/// @return an error where MuJoCo cannot make a model of the problem; stopped() where
/// VerifyRules::stop ended the work.
[[nodiscard]] Result<PathVerdict> verify_path(const ProblemFile& file, const PlanProblem& problem,
                                              const GivenPath& path, const VerifyRules& rules);

/// The same of a path of a robot, from its first to its last row: edges by ModelMarch, and MuJoCo's
/// collision detection on the model as it is.
/// @param contact  what hangs on the tool, what may touch.
/// @return also check_contact_rules()'s error.
[[nodiscard]] Result<PathVerdict> verify_path(const Robot& robot, const ContactRules& contact,
                                              const GivenPath& path, const VerifyRules& rules);

}  // namespace mjarm
