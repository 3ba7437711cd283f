#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/file_place.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm {

struct YamlMember;

/// A YAML document as a tree that knows where everything stands, without yaml-cpp's headers.
struct YamlNode {
  enum class Kind { nothing, scalar, list, map };

  Kind kind = Kind::nothing;
  FilePlace place;
  std::string text;             ///< of a scalar
  bool quoted = false;          ///< a scalar in quotes, or with a tag: text, whatever it looks like
  std::vector<YamlNode> items;  ///< of a list
  std::vector<YamlMember> members;  ///< of a map; keys are scalars, all different
};
/// A key of a map and what stands there.
struct YamlMember {
  YamlNode key, value;
};

/// Why a text is no YAML document, or none that is taken.
struct YamlFault {
  FilePlace place;
  std::string what;  ///< one line for people, without the place
};

/// Reads one document. Bounded, whatever the text holds: at most 32 levels and 200,000 nodes,
/// copies by aliases counted. An empty text gives `Kind::nothing` at no place.
[[nodiscard]] Result<YamlNode, YamlFault> read_yaml(const std::string& text);

/// The same, an error begins with `name:line:column:`.
[[nodiscard]] Result<YamlNode> read_yaml(const std::string& text, std::string_view name);

/// `name:line:column: what`; the place is left out where there is none.
[[nodiscard]] std::string at_place(std::string_view name, FilePlace place, std::string_view what);

}  // namespace mjarm
