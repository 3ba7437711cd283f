#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_lock.hpp"

namespace mjarm {

Result<std::optional<FolderLock>> FolderLock::try_lock(const std::filesystem::path& folder) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) {
    return fail(Errc::system, text(msg::core_cannot_read, folder.string(), system_message(errno)));
  }
  FolderLock lock(handle);
  if (::flock(handle, LOCK_EX | LOCK_NB) == 0) return std::optional(std::move(lock));
  if (errno == EWOULDBLOCK || errno == EINTR) return std::nullopt;
  return fail(Errc::system, text(msg::core_cannot_write, folder.string(), system_message(errno)));
}

/// By /proc/locks: "1: FLOCK  ADVISORY  WRITE 123 fd:01:4567 0 EOF", the last a number of a file.
std::optional<long> lock_holder(const std::filesystem::path& folder) {
  struct stat file{};
  if (::stat(folder.c_str(), &file) != 0) return std::nullopt;
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, mode, access, place;
    long process = 0;
    if (!(words >> number >> kind >> mode >> access >> process >> place)) continue;
    const bool here = place.substr(place.rfind(':') + 1) == std::to_string(file.st_ino);
    if (kind == "FLOCK" && here && process > 0) return process;
  }
  return std::nullopt;
}

FolderLock::~FolderLock() {
  if (handle_ >= 0) ::close(handle_);
}

}  // namespace mjarm
