#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/mjarm/demos/demos.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/session/stage.hpp"

namespace mjarm::app {

/// The robot that the user chose for a demo, with real meshes where they are asked for.
/// @param dof  number of joints the demo's postures are for; 0 = any.
[[nodiscard]] Result<Robot> load_demo_robot(const std::string& demo, const DemoOptions& options,
                                            int dof = 0);

/// A stage with that robot.
[[nodiscard]] Result<std::unique_ptr<session::Stage>> open_stage(const std::string& demo,
                                                                 const DemoOptions& options,
                                                                 int dof = 0);

/// Reads one value a joint, which must be within the joint's limits.
/// @return bad_input that names `option`, and the joint that cannot stand there.
[[nodiscard]] Result<std::vector<double>> read_posture(const std::string& option,
                                                       const std::string& words, const Arm& arm);

/// `goal`, with what the user wants otherwise of it.
[[nodiscard]] Pose changed(Pose goal, const std::optional<Eigen::Vector3d>& p,
                           const DemoValues& values);

/// Geometry alone: what the arm can reach.
[[nodiscard]] IkSolver reach_solver(const Robot& robot);
/// The same without touching itself or the scene: what it may do.
[[nodiscard]] IkSolver free_solver(const Robot& robot);

}  // namespace mjarm::app
