#pragma once

#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A loaded file and the arm in it: what nearly everything else starts from.
struct Robot {
  Model model;
  Arm arm;
};

/// Which arm of a file is meant, and how the file is read.
struct RobotOptions {
  std::string tip = {};  ///< as ArmOptions::tip; empty = the only sensible one
  LoadOptions load = {};
};

/// Loads a robot in one call: find_model_file(), Model::load(), find_arm().
/// @param name_or_path  a shipped model (`ur5e`, `panda`, ...), or the path of an MJCF or URDF
/// file.
/// @return the error of whichever of the three steps failed, one line.
[[nodiscard]] Result<Robot> load_robot(const std::string& name_or_path,
                                       const RobotOptions& options = {});

}  // namespace mjarm
