#include <windows.h>

#include <cstdint>
#include <string>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os_lock.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {
namespace {

/// Handles have 32 bits that count, on every Windows.
int number_of(HANDLE handle) { return static_cast<int>(reinterpret_cast<std::intptr_t>(handle)); }
HANDLE handle_of(int number) {
  return reinterpret_cast<HANDLE>(static_cast<std::intptr_t>(number));
}

/// A name that all processes of this session have for the folder; empty where it cannot be opened.
std::wstring name_of(const std::filesystem::path& folder) {
  const HANDLE handle =
      CreateFileW(folder.c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                  nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (handle == INVALID_HANDLE_VALUE) return {};
  BY_HANDLE_FILE_INFORMATION info{};
  const bool known = GetFileInformationByHandle(handle, &info) != FALSE;
  const DWORD code = GetLastError();
  CloseHandle(handle);
  SetLastError(code);
  if (!known) return {};
  const std::uint64_t index = (std::uint64_t{info.nFileIndexHigh} << 32) | info.nFileIndexLow;
  return utf16("Local\\mjarm-" + std::to_string(info.dwVolumeSerialNumber) + "-" +
               std::to_string(index));
}

}  // namespace

/// An event of the folder's name: it lives as long as somebody has it open.
Result<std::optional<FolderLock>> FolderLock::try_lock(const std::filesystem::path& folder) {
  const std::wstring name = name_of(folder);
  const HANDLE event = name.empty() ? nullptr : CreateEventW(nullptr, TRUE, FALSE, name.c_str());
  const DWORD code = GetLastError();
  if (event == nullptr) {
    return fail(Errc::system,
                text(msg::core_cannot_read, utf8(folder.wstring()), windows_message(code)));
  }
  FolderLock lock(number_of(event));
  if (code == ERROR_ALREADY_EXISTS) return std::nullopt;
  return std::optional(std::move(lock));
}

/// Windows does not tell.
std::optional<long> lock_holder(const std::filesystem::path&) { return std::nullopt; }

FolderLock::~FolderLock() {
  if (handle_ >= 0) CloseHandle(handle_of(handle_));
}

}  // namespace mjarm
