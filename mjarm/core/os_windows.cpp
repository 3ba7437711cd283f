#include <io.h>
#include <windows.h>

#include <atomic>
#include <cstdio>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {
namespace {

std::atomic<bool> interrupt_seen{false};

/// Called in a thread of its own. What is not taken here ends the process.
BOOL WINAPI on_interrupt(DWORD) { return interrupt_seen.exchange(true) ? FALSE : TRUE; }

/// File of a module of this process; null is the program.
std::filesystem::path file_of(HMODULE module) {
  std::wstring name(32768, L'\0');  // no path is longer
  const DWORD length = GetModuleFileNameW(module, name.data(), static_cast<DWORD>(name.size()));
  name.resize(length);
  return name;
}

}  // namespace

Result<std::filesystem::path> executable_path() {
  std::filesystem::path path = file_of(nullptr);
  if (path.empty()) {
    return fail(Errc::system, text(msg::core_no_executable_path, windows_message(GetLastError())));
  }
  return path;
}

std::filesystem::path library_of(const void* address) {
  HMODULE module = nullptr;
  const DWORD how =
      GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
  if (GetModuleHandleExW(how, static_cast<LPCWSTR>(address), &module) == FALSE) return {};
  return file_of(module);
}

std::optional<std::string> environment(const std::string& name) {
  const std::wstring wide = utf16(name);
  SetLastError(ERROR_SUCCESS);
  const DWORD size = GetEnvironmentVariableW(wide.c_str(), nullptr, 0);
  if (size == 0)
    return GetLastError() == ERROR_SUCCESS ? std::optional(std::string()) : std::nullopt;
  std::wstring value(size, L'\0');
  value.resize(GetEnvironmentVariableW(wide.c_str(), value.data(), size));
  return utf8(value);
}

std::string locale_name() {
  for (const char* variable : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    const std::optional<std::string> value = environment(variable);
    if (value && !value->empty()) return *value;
  }
  // The language of the desktop.
  wchar_t name[LOCALE_NAME_MAX_LENGTH] = L"";
  LCIDToLocaleName(MAKELCID(GetUserDefaultUILanguage(), SORT_DEFAULT), static_cast<wchar_t*>(name),
                   LOCALE_NAME_MAX_LENGTH, 0);
  return utf8(static_cast<wchar_t*>(name));
}

bool stderr_is_terminal() noexcept {
  DWORD mode = 0;
  const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
  return GetConsoleMode(console, &mode) != FALSE &&
         SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != FALSE;
}

int terminal_width() noexcept {
  CONSOLE_SCREEN_BUFFER_INFO info{};
  if (GetConsoleScreenBufferInfo(GetStdHandle(STD_ERROR_HANDLE), &info) == FALSE) return 80;
  return info.srWindow.Right - info.srWindow.Left + 1;
}

/// There is a desktop, even where nobody looks at it.
bool has_display() { return true; }

std::optional<std::filesystem::path> user_folder(const std::string& variable,
                                                 const std::string& below_home) {
  const std::filesystem::path named = utf16(environment(variable).value_or(""));
  if (named.is_absolute()) return named;
  for (const char* const home : {"HOME", "USERPROFILE"}) {
    const std::filesystem::path folder = utf16(environment(home).value_or(""));
    if (folder.is_absolute()) return folder / below_home;
  }
  return {};
}

long process_id() noexcept { return static_cast<long>(GetCurrentProcessId()); }

bool is_running(long process) noexcept {
  const HANDLE handle = OpenProcess(SYNCHRONIZE, FALSE, static_cast<DWORD>(process));
  if (handle == nullptr) return GetLastError() == ERROR_ACCESS_DENIED;
  const bool runs = WaitForSingleObject(handle, 0) == WAIT_TIMEOUT;
  CloseHandle(handle);
  return runs;
}

void catch_interrupts() noexcept { SetConsoleCtrlHandler(on_interrupt, TRUE); }

bool interrupted() noexcept { return interrupt_seen.load(); }

Result<void*> open_library(const std::string& name) {
  void* library = reinterpret_cast<void*>(LoadLibraryW(utf16(name).c_str()));
  if (library != nullptr) return library;
  return fail(Errc::not_available, name + ": " + windows_message(GetLastError()));
}

/// Whoever wants a symbol asks its library.
void publish_library(const std::string&) noexcept {}

void* library_symbol(void* library, const std::string& symbol) noexcept {
  return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(library), symbol.c_str()));
}

}  // namespace mjarm
