#pragma once

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/fast_robot_internal.hpp"
#include "mjarm/collision/fast_world_internal.hpp"

namespace mjarm::detail {

/// What users of FastRobot and FastChecker do not see, for the checks that are built on them.
struct FastAccess {
  static const FastRobotData& data(const FastRobot& robot) { return *robot.data_; }
  static const FastWorld& world(const FastChecker& checker) { return *checker.world_; }
  static const SolidScene* solids(const FastChecker& checker) { return checker.solids_.get(); }
  static const SphereMargins& closer_margins(const FastChecker& checker) { return checker.closer_; }
  static const FastKernels& kernels(const FastChecker& checker) { return *checker.kernels_; }
};

}  // namespace mjarm::detail
