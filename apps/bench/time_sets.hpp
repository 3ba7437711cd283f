#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/trajectory/time_cases.hpp"

namespace mjarm::app {

/// Motions of one kind to be timed.
struct TimeSet {
  std::string name;  ///< "rest", "state", "path_va", "path_vaj", "via_vaj", "ellipse"
  TimeProblem problem;
  JointLimits limits;
  std::vector<TimeCase> cases;
  /// [s] what durations are compared with, one a case: the shortest known ones (for path_vaj those
  /// without jerk limits). Empty where none are known.
  std::vector<double> best = {};
};

/// The sets of one robot. With a folder: `NAME_p2p.json`, and `NAME_paths.json`,
/// `NAME_ellipse.json` and `best_known.json` as far as they are there. Without: the robot's own
/// limits, and cases made at random, the same every time.
/// @param folder  empty = none.
[[nodiscard]] Result<std::vector<TimeSet>> load_time_sets(const std::string& robot,
                                                          const std::filesystem::path& folder);

}  // namespace mjarm::app
