#include <fcntl.h>
#include <io.h>
#include <windows.h>
// After windows.h.
#include <shellapi.h>

#include <cstdio>

#include "mjarm/core/os_streams.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {

void open_standard_streams() noexcept {
  std::FILE* const streams[] = {stdin, stdout, stderr};
  for (std::FILE* const stream : streams) {
    if (::_fileno(stream) < 0) (void)std::freopen("NUL", stream == stdin ? "rb" : "wb", stream);
    if (::_fileno(stream) >= 0) ::_setmode(::_fileno(stream), _O_BINARY);
  }
  SetConsoleOutputCP(CP_UTF8);
  SetConsoleCP(CP_UTF8);
}

/// Those of main() have lost what the code page of the system does not have.
std::vector<std::string> program_arguments(int, const char* const*) {
  int count = 0;
  wchar_t** const words = CommandLineToArgvW(GetCommandLineW(), &count);
  std::vector<std::string> arguments;
  for (int i = 1; i < count; ++i) arguments.push_back(utf8(words[i]));
  LocalFree(words);
  return arguments;
}

}  // namespace mjarm
