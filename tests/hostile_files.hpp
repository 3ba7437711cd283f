#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/temp_folder.hpp"

namespace mjarm::hostile {

/// What stands in a file. Long texts are made only when they are written: every test of the program
/// begins with all files.
class Content {
 public:
  Content(std::string text) : make_([text = std::move(text)] { return text; }) {}
  Content(const char* text) : Content(std::string(text)) {}
  Content(std::string (*make)()) : make_(make) {}

  [[nodiscard]] std::string text() const { return make_(); }

 private:
  std::function<std::string()> make_;
};

/// A file that must be refused with one line.
struct HostileFile {
  std::string label;
  std::string file;  ///< name of the model in the test's folder
  Content content;
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
