#pragma once

#include <cstddef>
#include <span>

#include "mjarm/program/program_steps_internal.hpp"
#include "mjarm/trajectory/tool_motion.hpp"

namespace mjarm::program::detail {

/// Whether the tool would not move from one to the other.
[[nodiscard]] bool same_pose(const Pose& a, const Pose& b);

/// The way of the tool in one step from `X`: straight, on an arc or all round a circle.
[[nodiscard]] Result<Curve> leg_of(const Step& step, const Pose& X);

/// Whether the corner between step `k` and the next one is blended.
[[nodiscard]] bool is_blended(std::span<const Step> steps, std::size_t k);

/// Speeds of the steps that one curve does.
/// @param tool_speed  [m/s] of those that name none.
[[nodiscard]] MotionOptions motion_options(std::span<const Step> steps, const Curve& curve,
                                           double tool_speed);

}  // namespace mjarm::program::detail
