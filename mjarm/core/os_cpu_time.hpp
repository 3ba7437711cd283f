#pragma once

namespace mjarm {

/// [s] Computing time of this process, all its threads, and its children that have ended.
[[nodiscard]] double cpu_seconds() noexcept;

}  // namespace mjarm
