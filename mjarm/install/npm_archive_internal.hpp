#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace mjarm::install {

/// Calls `take` with the name and the content of every file of a tar archive (ustar, as npm writes
/// it), up to the first header that is none.
void for_each_file(
    std::string_view tar,
    const std::function<void(std::string_view name, std::string_view content)>& take);

}  // namespace mjarm::install
