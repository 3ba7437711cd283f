#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/line_reader.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::app {

/// Loads a robot that peers can load too: `NAME.urdf` of a folder, or the shipped URDF or the given
/// file.
/// @param folder  of cases; empty = none.
[[nodiscard]] Result<Robot> load_bench_robot(const RobotChoice& options,
                                             const std::filesystem::path& folder);

/// The file has none.
[[nodiscard]] Error no_cases(const std::filesystem::path& file);
/// True where something of that name is there.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

/// Uniform within the limits; a joint without stops turns once, or slides a metre.
[[nodiscard]] JointVec random_q(const Arm& arm, Rng& rng);

/// [m] Length of all links together: no tool is farther from the first joint. May be infinite.
[[nodiscard]] double stretch_of(const Arm& arm);

/// Pose of the tool by MuJoCo's own forward kinematics of the loaded file.
/// @param q  [rad or m] shape (dof,).
[[nodiscard]] Result<Pose> mujoco_pose(const Robot& robot, std::span<const double> q);

/// True where the tool is within 1e-4 m and 1e-3 rad of `X_WT` by MuJoCo's own forward kinematics
/// of the loaded file, and `q` of the right size inside the limits.
[[nodiscard]] Result<bool> reaches(const Robot& robot, const Pose& X_WT,
                                   const std::vector<double>& q);

/// What a peer has to know of the robot, and in how many rounds; an error unless it comes from a
/// URDF.
[[nodiscard]] Result<JsonDoc> robot_job(const Robot& robot, int rounds);

/// Reads the cases of a set, JSON objects line by line, each by `take(object)`.
/// @param cases  what `take` adds to; an error where nothing is in it then.
template <class Case, class Take>
Result<void> read_cases(const std::filesystem::path& file, std::size_t longest,
                        const std::vector<Case>& cases, const Take& take) {
  Result<void> done = read_json_lines(file, longest, take);
  if (done && cases.empty()) done = fail(no_cases(file));
  return done;
}

}  // namespace mjarm::app
