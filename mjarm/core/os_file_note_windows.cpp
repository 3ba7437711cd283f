#include <windows.h>

#include "mjarm/core/os_file_note.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {
namespace {

/// NTFS keeps any number of streams with a file or folder.
std::wstring stream(const std::filesystem::path& path, const std::string& name) {
  return path.wstring() + L":mjarm." + utf16(name);
}

/// Else a file of that name would be made.
bool keeps_streams(const std::filesystem::path& path) {
  const HANDLE handle =
      CreateFileW(path.c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                  OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (handle == INVALID_HANDLE_VALUE) return false;
  DWORD flags = 0;
  const bool known = GetVolumeInformationByHandleW(handle, nullptr, 0, nullptr, nullptr, &flags,
                                                   nullptr, 0) != FALSE;
  CloseHandle(handle);
  return known && (flags & FILE_NAMED_STREAMS) != 0;
}

HANDLE open(const std::wstring& name, DWORD access, DWORD how) {
  return CreateFileW(name.c_str(), access, FILE_SHARE_READ, nullptr, how,
                     FILE_FLAG_BACKUP_SEMANTICS, nullptr);
}

}  // namespace

void set_file_note(const std::filesystem::path& path, const std::string& name,
                   const std::string& note) noexcept {
  if (!keeps_streams(path)) return;
  const HANDLE handle = open(stream(path, name), GENERIC_WRITE, CREATE_ALWAYS);
  if (handle == INVALID_HANDLE_VALUE) return;
  DWORD written = 0;
  WriteFile(handle, note.data(), static_cast<DWORD>(note.size()), &written, nullptr);
  CloseHandle(handle);
}

std::optional<std::string> file_note(const std::filesystem::path& path, const std::string& name) {
  constexpr DWORD kLongest = 256;
  if (!keeps_streams(path)) return std::nullopt;
  const HANDLE handle = open(stream(path, name), GENERIC_READ, OPEN_EXISTING);
  if (handle == INVALID_HANDLE_VALUE) return std::nullopt;
  std::string note(kLongest, '\0');
  DWORD size = 0;
  const bool read = ReadFile(handle, note.data(), kLongest, &size, nullptr) != FALSE;
  CloseHandle(handle);
  if (!read) return std::nullopt;
  note.resize(size);
  return note;
}

void remove_file_note(const std::filesystem::path& path, const std::string& name) noexcept {
  if (keeps_streams(path)) DeleteFileW(stream(path, name).c_str());
}

}  // namespace mjarm
