#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace mjarm::episode {

/// A file of numpy: little-endian doubles in the order of C (format version 1.0, NEP 1).
/// @param shape  its product is the number of values.
[[nodiscard]] std::string npy(std::span<const double> values,
                              const std::vector<std::size_t>& shape);

}  // namespace mjarm::episode
