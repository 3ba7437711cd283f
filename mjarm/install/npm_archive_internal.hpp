#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace mjarm::install {

/// The bytes that gzip packed in `packed`; empty where they are damaged, or are more than `most`.
[[nodiscard]] std::string gunzipped(std::string_view packed, std::size_t most);

/// Calls `take` with the name and the content of every file of a tar archive (ustar, as npm writes
/// it), up to the first header that is none.
void for_each_file(
    std::string_view tar,
    const std::function<void(std::string_view name, std::string_view content)>& take);

}  // namespace mjarm::install
