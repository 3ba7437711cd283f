#pragma once

#include <memory>

#include "mjarm/core/ranks.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Joins the processes that one `mpirun` started, once in a process; they part when it is
/// destroyed.
/// @return null where this process is alone; an error where it is one of several and mjarm was
///         built without MPI (CMake option MJARM_MPI), or MPI does not start.
[[nodiscard]] Result<std::unique_ptr<Ranks>> join_processes();

}  // namespace mjarm::app
