#pragma once

#include "apps/mjarm/learn/exercise.hpp"

namespace mjarm::app {

/// A solver in Python, `least_squares(robot, goal, q)` or `least_squares(goal, q)`: goals that can
/// be reached, and some that cannot.
[[nodiscard]] Result<LearnReport> check_python_solver(const Exercise& exercise);

}  // namespace mjarm::app
