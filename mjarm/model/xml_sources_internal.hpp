#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/error.hpp"

namespace mjarm {

/// An element of a description and the file it stands in.
struct SourceElement {
  const tinyxml2::XMLElement* element;
  const std::string* file;
};

/// The files of a description as written: the main one and all it includes, read within bounds.
class XmlSources {
 public:
  struct Document {
    std::string name;
    std::string text;
    tinyxml2::XMLDocument xml;
    const tinyxml2::XMLElement* included_at = nullptr;  ///< null for the main file
    /// Where MuJoCo looks for it, of a shipped file that is not there; else empty.
    std::string stands_for = {};
  };

  /// Reads `file` and its includes; a file that is not there is left out. As in MuJoCo, includes
  /// are looked for from the folder of `file`, then from that of the file that includes them; what
  /// is in neither may be a shipped model, `..` at its front left out.
  /// @param allow_outside  follow includes that lie outside the folder of `file` and are not
  /// shipped with mjarm.
  explicit XmlSources(const std::filesystem::path& file, bool allow_outside = false);

  /// Why the files cannot be taken as they are (no XML, no UTF-8, too much, outside); one line.
  [[nodiscard]] const std::optional<Error>& fault() const { return fault_; }
  /// The main file first; empty where it cannot be read.
  [[nodiscard]] const std::vector<std::unique_ptr<Document>>& documents() const {
    return documents_;
  }
  /// The file that an `<include>` puts in; null where it is not there.
  [[nodiscard]] const Document* included_by(const tinyxml2::XMLElement& include) const;
  /// All elements, the main file first.
  [[nodiscard]] const std::vector<SourceElement>& elements() const { return elements_; }

 private:
  /// Where an include is, and where MuJoCo would look for it.
  struct Place {
    std::filesystem::path path;
    std::string stands_for = {};  ///< as in Document
  };

  void add(const Place& place, const tinyxml2::XMLElement* included_at);
  void add_include(const Document& document, const tinyxml2::XMLElement& include);
  [[nodiscard]] std::optional<Error> read(Document& document);
  [[nodiscard]] Place find(const Document& document, const std::string& name) const;
  void fail_with(std::optional<Error> error);

  std::filesystem::path folder_;
  bool allow_outside_;
  std::vector<std::unique_ptr<Document>> documents_;
  std::vector<SourceElement> elements_;
  std::size_t bytes_ = 0;   ///< read so far
  std::size_t markup_ = 0;  ///< elements and attributes so far, at most
  std::optional<Error> fault_;
};

}  // namespace mjarm
