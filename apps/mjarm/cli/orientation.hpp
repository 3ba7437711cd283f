#pragma once

#include <Eigen/Core>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"

namespace mjarm::app {

/// Reads how the tool is to stand from the values of `--euler` and `--quat`.
/// @return a usage error unless exactly one of them is given.
[[nodiscard]] Result<Eigen::Matrix3d> parse_rotation(const std::string& euler,
                                                     const std::string& quat);

/// Reads what of a pose must be met, the value of `--task`.
/// @return a usage error with the nearest word.
[[nodiscard]] Result<IkTask> parse_task(const std::string& word);

}  // namespace mjarm::app
