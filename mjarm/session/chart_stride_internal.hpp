#pragma once

#include <algorithm>
#include <cstddef>

namespace mjarm::session {

/// Every so many of `count` rows become points of a curve: some 2000, more than that no page can
/// show.
[[nodiscard]] inline std::size_t chart_stride(std::size_t count) {
  return std::max<std::size_t>(1, count / 2000);
}

}  // namespace mjarm::session
