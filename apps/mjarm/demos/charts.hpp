#pragma once

#include <span>
#include <string>

#include "mjarm/model/arm.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/sim/recorder.hpp"

namespace mjarm::app {

/// One page about a run: tool path from three sides (planned dashed, executed solid), error, joint
/// values with their limits, tool speed.
[[nodiscard]] Plot motion_plot(const std::string& title, const Arm& arm,
                               std::span<const RecordRow> rows);

}  // namespace mjarm::app
