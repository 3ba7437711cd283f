#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "mjarm/core/os.hpp"
#include "mjarm/core/os_lock.hpp"

namespace mjarm::testing {

/// All tests share one display with one mouse and one keyboard, which a new window takes from the
/// others: so they take turns, also those of other processes.
class Turn {
 public:
  Turn() {
    const auto folder = temp_directory() / "mjarm_window_test";
    std::filesystem::create_directories(folder);
    while (!lock_) {
      Result<std::optional<FolderLock>> got = FolderLock::try_lock(folder);
      if (!got) break;  // nobody to take turns with
      lock_ = std::move(*got);
      if (!lock_) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

 private:
  std::optional<FolderLock> lock_;
};

}  // namespace mjarm::testing
