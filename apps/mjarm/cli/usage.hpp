#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::app {

/// Reads a whole number >= 0, as `--seed 7`. @return an error that names `option`.
[[nodiscard]] Result<std::uint64_t> parse_whole(const std::string& option,
                                                const std::string& value);

/// Reads a whole number from `min` (>= 0) to `max`, as `--rounds 5`. @return an error that names
/// `option`.
[[nodiscard]] Result<int> parse_count(const std::string& option, const std::string& value, int max,
                                      int min = 1);

/// Reads the value of `--threads`, 1 to 1024.
[[nodiscard]] Result<int> parse_threads(const std::string& value);

/// Reads one of some words, as `--task axis`.
/// @return its place in `words`, or an error that names `option` and all of them.
[[nodiscard]] Result<std::size_t> parse_choice(const std::string& option, const std::string& value,
                                               std::span<const std::string> words);

/// Reads the value of an option that is a list of `size` numbers, e.g. `--pos 1,2,3`.
/// @return an error that names `option`; a usage error where `value` is empty.
[[nodiscard]] Result<std::vector<double>> parse_list(const std::string& option,
                                                     const std::string& value, Quantity quantity,
                                                     std::size_t size);

/// Reads one value a joint: angles for hinges, lengths for slides.
[[nodiscard]] Result<std::vector<double>> parse_joints(const std::string& option,
                                                       const std::string& value, const Arm& arm);

/// Size of a picture or a window, both sides from 1 to 8192.
struct PixelSize {
  int width;
  int height;
};
/// Reads `1280x720`. @return a usage error that names `option`.
[[nodiscard]] Result<PixelSize> parse_size(const std::string& option, std::string_view value);

/// Puts the name of the option before an error about its value: `--q: "x" is not a number`.
[[nodiscard]] Error in_option(const std::string& option, Error error);

}  // namespace mjarm::app
