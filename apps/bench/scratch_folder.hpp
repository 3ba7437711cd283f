#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "mjarm/core/os.hpp"

namespace mjarm::app {

/// A folder of its own that goes with this object.
class ScratchFolder {
 public:
  /// @param purpose  part of its name: no two of one process have the same.
  explicit ScratchFolder(const std::string& purpose)
      : path_(temp_directory() / ("mjarm_" + purpose + "_" + std::to_string(process_id()))) {
    std::error_code ignored;
    std::filesystem::create_directories(path_, ignored);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace mjarm::app
