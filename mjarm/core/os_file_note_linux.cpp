#include <sys/xattr.h>

#include "mjarm/core/os_file_note.hpp"

namespace mjarm {
namespace {

/// The system keeps the notes of programs apart from its own.
std::string full_name(const std::string& name) { return "user.mjarm." + name; }

}  // namespace

void set_file_note(const std::filesystem::path& path, const std::string& name,
                   const std::string& note) noexcept {
  ::setxattr(path.c_str(), full_name(name).c_str(), note.data(), note.size(), 0);
}

std::optional<std::string> file_note(const std::filesystem::path& path, const std::string& name) {
  constexpr std::size_t kLongest = 256;
  std::string note(kLongest, '\0');
  const ssize_t size = ::getxattr(path.c_str(), full_name(name).c_str(), note.data(), note.size());
  if (size < 0) return std::nullopt;
  note.resize(static_cast<std::size_t>(size));
  return note;
}

void remove_file_note(const std::filesystem::path& path, const std::string& name) noexcept {
  ::removexattr(path.c_str(), full_name(name).c_str());
}

}  // namespace mjarm
