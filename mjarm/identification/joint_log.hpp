#pragma once

#include <filesystem>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Joint positions and torques of an arm, a row a time step.
struct JointLog {
  double timestep = 0;           ///< [s] > 0 from row to row
  std::vector<JointVec> q;       ///< [rad or m] (dof,) measured
  std::vector<JointVec> torque;  ///< [N m or N] (dof,) of the drives at the joints; as many rows
};

/// Reads the columns `time [s]`, `q JOINT [..]` and `torque JOINT [..]` of a log as `mjarm run`
/// writes it (Recorder::to_csv()); other columns may stand between.
/// @return bad_input that names file and line or column: a joint of `arm` that is missing, a number
///         that is none, rows that are not evenly spaced in time.
[[nodiscard]] Result<JointLog> read_joint_log(const std::filesystem::path& file, const Arm& arm);

}  // namespace mjarm
