#pragma once

#include "mjarm/core/pose.hpp"
#include "mjarm/kinematics/general_six_block_internal.hpp"
#include "mjarm/kinematics/trig_series_internal.hpp"

namespace mjarm::detail {

/// The equations of the pose X_WT by these rows.
void set_equations(const GeneralGeometry& g, const GeneralRows& rows, const Pose& X_WT,
                   GeneralEquations& out) noexcept;

/// The determinant of the equations as a function of joint 4; its answers are among its roots.
[[nodiscard]] TrigSeries determinant_series(const GeneralGeometry& g,
                                            const GeneralEquations& equations,
                                            const Pose& X_WT) noexcept;

}  // namespace mjarm::detail
