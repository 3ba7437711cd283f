#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mjarm/core/messages.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

/// Number of single-character changes (insert, delete, replace, swap of neighbours) from `a` to
/// `b`; upper and lower case count as equal. Bytes, not characters.
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

/// The word of `known` that was probably meant by `word`: the nearest by edit distance, the first
/// of equals, and no farther than a third of the word's length (at least 2). Some words of other
/// programs are known by what they mean (`--rpy` for `--euler`). Never the word itself.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view word,
                                                      std::span<const std::string> known);

/// `a, b, c`: words in a message, parted as the language in use parts them.
[[nodiscard]] std::string listed(std::span<const std::string> words);

/// Which of `names` the word is.
/// @param unknown  of the usage error for another word; gets the word and listed() names.
[[nodiscard]] Result<std::size_t> index_of_word(std::string_view word,
                                                std::span<const std::string_view> names,
                                                Msg unknown);

/// ` (did you mean "NAME"?)` in the language in use, or nothing where no known word is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace mjarm
