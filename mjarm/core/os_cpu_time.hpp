#pragma once

namespace mjarm {

/// [s] Computing time of this process, all its threads, and its children that have ended.
[[nodiscard]] double cpu_seconds() noexcept;
/// [s] The same with the time in which its threads were ready, but others had the cores; without it
/// where the system does not tell. Threads that have ended count with their computing time alone.
[[nodiscard]] double busy_seconds() noexcept;

}  // namespace mjarm
