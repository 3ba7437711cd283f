#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mjarm/core/error.hpp"
#include "mjarm/model/xml_sources_internal.hpp"

namespace mjarm {

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
[[nodiscard]] Error complaint_error(const XmlSources& sources, std::string_view words,
                                    bool trust_lines);

/// `complaint` in the user's language as far as it is known, with `hint` (may be empty) after it.
[[nodiscard]] std::string in_users_words(const Complaint& complaint, const std::string& hint);

}  // namespace mjarm
