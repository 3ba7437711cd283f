#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mjarm {

/// Keeps a short text with a file or folder, beside its content (extended attributes): it goes
/// along when that is renamed, and is lost with it. Where the file system keeps no such notes,
/// nothing happens.
void set_file_note(const std::filesystem::path& path, const std::string& name,
                   const std::string& note) noexcept;

/// The note of that name; none where there is none.
[[nodiscard]] std::optional<std::string> file_note(const std::filesystem::path& path,
                                                   const std::string& name);

void remove_file_note(const std::filesystem::path& path, const std::string& name) noexcept;

}  // namespace mjarm
