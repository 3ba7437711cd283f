#pragma once

#include <string>

#include "mjarm/collision/fast_robot_internal.hpp"

/// What FastRobot::create() takes longest for, in UserCache: which spheres can meet, and how far
/// groups with few joints between them keep apart.
namespace mjarm::detail {

/// Of a robot whose groups are there.
[[nodiscard]] std::string key_of_pairs(const FastRobotData& data, const LinkChain& chain);
/// Of what add_pairs() and add_apart() make.
[[nodiscard]] std::string bytes_of_pairs(const FastRobotData& data);
/// Puts them into a robot whose groups are there; false, and nothing is changed, where these are
/// not the bytes of pairs of such a robot.
[[nodiscard]] bool read_pairs(const std::string& bytes, FastRobotData& data);

}  // namespace mjarm::detail
