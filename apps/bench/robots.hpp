#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::app {

/// Loads a robot that peers can load too: `NAME.urdf` of a folder, or the shipped URDF or the given
/// file.
/// @param folder  of cases; empty = none.
[[nodiscard]] Result<Robot> load_bench_robot(const RobotChoice& options,
                                             const std::filesystem::path& folder);

/// Uniform within the limits; a joint without stops turns once, or slides a metre.
[[nodiscard]] JointVec random_q(const Arm& arm, Rng& rng);

/// [m] Length of all links together: no tool is farther from the first joint. May be infinite.
[[nodiscard]] double stretch_of(const Arm& arm);

/// True where the tool is within 1e-4 m and 1e-3 rad of `X_WT` by MuJoCo's own forward kinematics
/// of the loaded file, and `q` of the right size inside the limits.
[[nodiscard]] Result<bool> reaches(const Robot& robot, const Pose& X_WT,
                                   const std::vector<double>& q);

/// What a peer has to know of the robot; an error unless it comes from a URDF.
[[nodiscard]] Result<JsonDoc> robot_job(const Robot& robot);

}  // namespace mjarm::app
