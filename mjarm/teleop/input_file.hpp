#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/teleop/teleop.hpp"

namespace mjarm {

/// What is asked from a time on.
struct TimedInput {
  double time = 0;  ///< [s] >= 0
  TeleopInput input;
};

/// Reads inputs that were recorded, or written by a program: a table of comma separated values, a
/// line a time, each of which holds until the next; times rise from 0. Columns `time` [s], `vx`,
/// `vy`, `vz` [m/s], `wx`, `wy`, `wz` [rad/s], `gripper` (TeleopInput::grip_to) and, where wanted,
/// `in_tool` (1: in the axes of the tool, 0: of the world), in this order; units in brackets after
/// a name are passed over.
/// @param frame   of the velocities of lines without `in_tool`.
/// @param source  for messages.
/// @return bad_input that names the line.
[[nodiscard]] Result<std::vector<TimedInput>> parse_inputs(std::string_view csv, TwistFrame frame,
                                                           const std::string& source);
/// The same from a file of at most 64 MiB.
[[nodiscard]] Result<std::vector<TimedInput>> read_inputs(const std::filesystem::path& file,
                                                          TwistFrame frame);

/// The table that parse_inputs() reads. TeleopInput::grip is not kept.
[[nodiscard]] std::string inputs_csv(std::span<const TimedInput> inputs);

}  // namespace mjarm
