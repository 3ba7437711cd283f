#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>

#include <string>

#include "mjarm/core/os_file.hpp"

namespace mjarm {

std::FILE* open_file(const std::filesystem::path& path, const char* mode) noexcept {
  const std::string name(mode);
  if (name != "wbx") return ::_wfopen(path.c_str(), std::wstring(name.begin(), name.end()).c_str());
  // The C library of MinGW-w64 does not know `x`.
  const int file =
      ::_wopen(path.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);
  return file < 0 ? nullptr : ::_fdopen(file, "wb");
}

}  // namespace mjarm
