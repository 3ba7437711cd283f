#pragma once

#include "mjarm/planning/way_prover.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::detail {

/// Whether all of a motion is proved. Between two moments h apart each joint stays within h^2 / 8
/// times its largest acceleration of the straight way, so that few moments prove what is far from
/// everything; the others are looked at more closely.
[[nodiscard]] bool is_proved(const Trajectory& motion, const WayProver& prover);

}  // namespace mjarm::detail
