#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tests/support/temp_folder.hpp"

namespace mjarm::hostile {

/// A file that must be refused with one line.
struct HostileFile {
  std::string label;
  std::string file;  ///< name of the model in the test's folder
  std::string content;
  std::vector<std::string> words;  ///< all of these stand in the line
  /// Lays down what the model needs besides; may be null.
  void (*prepare)(const support::TempFolder& folder) = nullptr;
};

void PrintTo(const HostileFile& hostile, std::ostream* out);

/// Things that are no description at all, or one that eats its reader.
[[nodiscard]] std::vector<HostileFile> hostile_texts();
/// MJCF whose numbers and amounts cannot be had.
[[nodiscard]] std::vector<HostileFile> hostile_mjcf();
/// Descriptions that name files which they should not, or which are not what they seem.
[[nodiscard]] std::vector<HostileFile> hostile_references();
[[nodiscard]] std::vector<HostileFile> hostile_urdf();

/// A well-formed MJCF with `inside` in its <worldbody>, which begins at line 3.
[[nodiscard]] std::string mjcf(const std::string& inside, const std::string& before = "");
/// One with a sphere and `asset` among its assets.
[[nodiscard]] std::string with_asset(const std::string& asset);
/// `words` `times` times.
[[nodiscard]] std::string repeat(const std::string& words, std::size_t times);

}  // namespace mjarm::hostile
