#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/xml_sources_internal.hpp"

namespace mjarm {

/// True where `path` lies in one of `roots` or below, by its words alone (links are not followed).
[[nodiscard]] bool is_inside(const std::filesystem::path& path,
                             std::span<const std::filesystem::path> roots);
[[nodiscard]] inline bool is_inside(const std::filesystem::path& path,
                                    std::initializer_list<std::filesystem::path> roots) {
  return is_inside(path, std::span(roots.begin(), roots.size()));
}

/// Everything about a description that must be known before MuJoCo may see it, at a cost that the
/// size of the files bounds: what it would do to memory and time, numbers, names, files it names.
/// @param sources  without fault.
[[nodiscard]] Result<void> preflight(const XmlSources& sources, const LoadOptions& options);

/// Names and texts that are no UTF-8, numbers that are not finite or absurdly large.
[[nodiscard]] Result<void> check_attributes(const XmlSources& sources);

/// Counts and sizes that would eat all memory or time; the time step.
[[nodiscard]] Result<void> check_amounts(const XmlSources& sources);

/// A place where a file may be that MJCF names.
struct AssetFile {
  std::filesystem::path path;
  std::string_view kind;  ///< of the element that names it: `mesh`, `hfield`, ...
  std::string_view name;  ///< as it is written
  SourceElement source;
};
/// Of files other than includes. Which of several <compiler> counts need not be known: of each file
/// all places are told where it may be looked for.
[[nodiscard]] std::vector<AssetFile> asset_files(const XmlSources& sources);

/// The files that MJCF names: inside the model's folder, regular, of a sensible size, and as long
/// as they say they are.
[[nodiscard]] Result<void> check_files(const XmlSources& sources, const LoadOptions& options);

/// What is wrong with a mesh, texture or height field; none where all is well, or where it is not
/// there.
/// @param element  the kind of element that names the file: `mesh`, `hfield`, ...
/// @param shown    the file's name in the description.
[[nodiscard]] std::optional<std::string> asset_fault(const std::filesystem::path& path,
                                                     std::string_view element,
                                                     std::string_view shown);

}  // namespace mjarm
