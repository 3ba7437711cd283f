#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/error.hpp"

namespace mjarm {

/// An element of a description and the file it stands in.
struct SourceElement {
  const tinyxml2::XMLElement* element;
  const std::string* file;
};

/// The files of a description as written: the main one and all it includes.
class XmlSources {
 public:
  /// Reads `file` and its includes; what cannot be read is left out.
  explicit XmlSources(const std::filesystem::path& file);

  /// All elements, the main file first.
  [[nodiscard]] const std::vector<SourceElement>& elements() const { return elements_; }

 private:
  void add(const std::filesystem::path& path, const std::filesystem::path& folder);

  struct Document {
    std::string name;
    tinyxml2::XMLDocument xml;
  };
  std::vector<std::unique_ptr<Document>> documents_;
  std::vector<SourceElement> elements_;
};

/// MuJoCo's words taken apart.
struct Complaint {
  std::string what;  ///< in MuJoCo's English, one line
  std::string kind;  ///< name of the XML element, such as `geom`; empty where MuJoCo names none
  std::string name;  ///< the element's attribute `name`; empty where MuJoCo names none
  std::string word;  ///< first word in single quotes in `what`
  int line = 0;      ///< in the main file; 0 where MuJoCo names none
};

/// Reads "[XML ]Error: WHAT\nElement 'KIND', line N" and "...\nElement name 'NAME', id I, line N".
[[nodiscard]] Complaint take_apart(std::string_view words);

/// One line for users: `FILE:LINE: <element>: what`, with the nearest right word. MuJoCo gives no
/// line for included files; then the element is looked for in them.
/// @param trust_lines  false where MuJoCo has read another text than the file (its lines are void).
[[nodiscard]] Error complaint_error(const std::filesystem::path& file, std::string_view words,
                                    bool trust_lines);

/// Where in `file` or its includes a NaN stands; none where there is none.
[[nodiscard]] std::optional<Error> nan_error(const std::filesystem::path& file);

/// `complaint` in the user's language as far as it is known, with `hint` (may be empty) after it.
[[nodiscard]] std::string in_users_words(const Complaint& complaint, const std::string& hint);

}  // namespace mjarm
