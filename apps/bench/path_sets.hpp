#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Paths of one kind.
struct PathSet {
  std::string name;       ///< "lines", "ellipse_far", "ellipse"; "beyond"
  bool possible = false;  ///< whether the right answer is a path
  std::vector<std::vector<Pose>> paths;
};

/// A robot and the paths asked of it.
struct PathProblem {
  std::string name;  ///< "ur5e", or the stem of a file
  Robot robot;
  std::vector<std::vector<double>> seeds;  ///< [rad or m] where to start: home, then random ones
  std::vector<PathSet> sets;
};

/// Loads a robot and its paths. With a folder: `NAME.urdf` there, and `NAME_lines.jsonl`,
/// `NAME_ellipse_far.jsonl` and `NAME_ellipse.jsonl` (which leaves the reach) as far as they are
/// there. Without such files: straight lines that some branch is known to follow, and others that
/// leave the reach, the same every time.
/// @param folder  empty = none.
[[nodiscard]] Result<PathProblem> load_path_problem(const RobotChoice& options,
                                                    const std::filesystem::path& folder);

}  // namespace mjarm::app
