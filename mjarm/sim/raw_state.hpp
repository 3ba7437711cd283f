#pragma once

#include <span>

#include "mjarm/sim/sim.hpp"

struct mjData_;
struct mjModel_;

/// States of a world in MuJoCo's own memory, for the rooms that may include mujoco.h.
namespace mjarm::raw {

/// Puts `d` into a state; what follows from it is left to the caller.
/// @return false, and nothing is changed, where the snapshot belongs to another model.
[[nodiscard]] bool set_state(const mjModel_& m, const Snapshot& snapshot, mjData_& d);

/// The same; a snapshot without numbers is the state in which the model starts.
[[nodiscard]] bool set_state_or_start(const mjModel_& m, const Snapshot& snapshot, mjData_& d);

/// Computes in `d` where the bodies would be if some values of `at.qpos` were others: positions
/// only; all else stands as in `at`.
/// @param index  shape (n,), places in qpos; others are ignored.
/// @param values shape (n,) [rad or m]
void place_otherwise(const mjModel_& m, const mjData_& at, std::span<const int> index,
                     std::span<const double> values, mjData_& d);

/// True where a body has the same pose in both, to 1e-6 [m, and of entries of its rotation].
[[nodiscard]] bool same_place(const mjData_& a, const mjData_& b, int body);

}  // namespace mjarm::raw
