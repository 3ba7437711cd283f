#pragma once

#include <memory>
#include <string>

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

/// Geometry alone: what the arm can reach.
[[nodiscard]] IkSolver reach_solver(const Robot& robot);
/// The same without touching itself or the scene: what it may do.
[[nodiscard]] IkSolver free_solver(const Robot& robot);

}  // namespace mjarm::app
