#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Exactly `count` finite numbers, parted by white space; empty where `words` are anything else.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view words, std::size_t count);

/// An error at an element: `FILE:LINE: <element "name">: what`.
[[nodiscard]] Error urdf_error(const std::filesystem::path& file,
                               const tinyxml2::XMLElement& element, std::string_view what);

/// Checks what MuJoCo would pass over or would not place: names, references between links and
/// joints, one root, joint types, numbers, limits.
[[nodiscard]] Result<void> validate_urdf(const std::filesystem::path& file,
                                         const tinyxml2::XMLElement& robot);

/// Refuses misspelt elements and attributes, which MuJoCo passes over in silence, with the nearest
/// right word; words that are far from all of URDF's are somebody's extension and stay. A
/// <geometry> must hold a shape.
[[nodiscard]] Result<void> validate_urdf_words(const std::filesystem::path& file,
                                               const tinyxml2::XMLElement& robot);

/// The folders whose files a URDF may name: its own, the ROS package it lies in, the packages it
/// names by `package://` (they hold a package.xml, or the file), and what the user has named as a
/// place of packages, by options or environment.
[[nodiscard]] std::vector<std::filesystem::path> urdf_roots(const std::filesystem::path& file,
                                                            const tinyxml2::XMLElement& robot,
                                                            const LoadOptions& options);

/// Makes every mesh file name absolute; refuses files outside of `urdf_roots`, unless the options
/// allow them, and files that are no meshes. Visual meshes of a format that MuJoCo cannot read are
/// taken out, with a line in `warnings`.
[[nodiscard]] Result<void> resolve_meshes(const std::filesystem::path& file,
                                          tinyxml2::XMLElement& robot, const LoadOptions& options,
                                          std::vector<std::string>& warnings);

/// Inertias with a principal moment that is not positive, which MuJoCo refuses, lose their products
/// of inertia; told in `warnings`.
void mend_inertia(const std::filesystem::path& file, tinyxml2::XMLElement& robot,
                  std::vector<std::string>& warnings);

/// A URDF that describes geometry alone has links without mass; MuJoCo needs mass on whatever a
/// joint moves. Such links get a trace of it. Where a link has collision shapes but no inertia,
/// MuJoCo takes them for solid water; both are told in `warnings`.
void give_mass(const std::filesystem::path& file, tinyxml2::XMLElement& robot,
               std::vector<std::string>& warnings);

/// All child elements of `parent` of the given name.
[[nodiscard]] std::vector<tinyxml2::XMLElement*> children(tinyxml2::XMLElement& parent,
                                                          const char* name);
[[nodiscard]] std::vector<const tinyxml2::XMLElement*> children(const tinyxml2::XMLElement& parent,
                                                                const char* name);

}  // namespace mjarm
