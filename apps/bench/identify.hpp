#pragma once

#include "apps/bench/robust.hpp"
#include "apps/bench/suite.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

/// In worlds that the model does not know the arm is excited without its payload and with it; what
/// identify() makes of the two logs beside the truth, and laps of an ellipse by computed torque
/// that knows no payload, the one it was told, and the one that was found. Writes the table or the
/// JSON document.
/// @return an error where there is no way to excite the arm, or a simulation broke down.
[[nodiscard]] Result<int> run_identify(const ReportOptions& report, const RobustWords& words,
                                       const Robot& robot);

}  // namespace mjarm::app
