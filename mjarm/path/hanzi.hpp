#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/path/letters.hpp"

namespace mjarm {

/// Where `mjarm models install hanzi` keeps the strokes of Chinese characters. It need not exist.
[[nodiscard]] Result<std::filesystem::path> hanzi_file();

/// Units to a side of the square in which a character stands, in its file.
inline constexpr double kHanziSquare = 1024;
/// How many of them the square reaches below the line y = 0 of the file.
inline constexpr double kHanziBelow = 124;

/// Strokes of those of `characters` that are in `file`, in the order of writing, in the square
/// [0, 1] x [0, 1]; all smooth. Each line of the file is a character in UTF-8, a blank, and its
/// strokes parted by `;`, whose points `x,y` (whole numbers, y up) are parted by blanks.
/// @return an error that names the line that is no such line.
[[nodiscard]] Result<std::map<std::string, std::vector<Stroke>>> hanzi_strokes(
    const std::filesystem::path& file, const std::set<std::string>& characters);

}  // namespace mjarm
