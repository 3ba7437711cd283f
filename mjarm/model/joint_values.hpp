#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// Joint `i` of `arm` as a user gave it: rad or m, or with a unit of what the joint does.
/// @return bad_input, one line that names the joint, where the unit is another one's, or where the
///         value has none and cannot be meant in rad or m: a turn too many, more than 10 m, or more
///         than 1 rad or 1 m beyond the joint's limits. What is said within the limits is taken.
[[nodiscard]] Result<double> joint_value(const WrittenNumber& written, const Arm& arm, int i);

/// Reads a list of joint values, one a joint: `0,-90deg,25mm`.
/// @return bad_input as above, or where their number is not that of the joints.
[[nodiscard]] Result<std::vector<double>> parse_joint_values(std::string_view words,
                                                             const Arm& arm);

/// Looks at joint values that could not carry a unit, as those of JSON: `q` (dof,) [rad or m].
/// @return bad_input, one line that names the joint, where a value is more than a turn or 10 m and
///         more than 1 rad or 1 m beyond the limits, but not in degrees or millimetres.
[[nodiscard]] Result<void> check_joint_units(std::span<const double> q, const Arm& arm);

}  // namespace mjarm
