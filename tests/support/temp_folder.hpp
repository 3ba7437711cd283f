#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mjarm::support {

/// A folder of its own for one test, removed with this object.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a file into the folder (making folders in between) and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view content) const;
  /// Content of a file in the folder. @throws std::runtime_error where there is none.
  [[nodiscard]] std::string read(const std::string& name) const;
  [[nodiscard]] bool exists(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

}  // namespace mjarm::support
