#pragma once

#include "apps/mjarm/learn/exercise.hpp"

namespace mjarm::app {

/// A planner in Python, `plan(robot, start, goal)`: round the wall, there and back.
[[nodiscard]] Result<LearnReport> check_python_planner(const Exercise& exercise);

}  // namespace mjarm::app
