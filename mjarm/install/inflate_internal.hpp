#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mjarm::install {

enum class Packing { deflate, gzip };

/// The bytes packed in `packed`; empty where they are damaged, or are more than `most`.
[[nodiscard]] std::string inflated(std::string_view packed, Packing packing, std::size_t most);

}  // namespace mjarm::install
