#include "mjarm/core/os_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"

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

FolderLock::~FolderLock() {
  if (handle_ >= 0) ::close(handle_);
}

}  // namespace mjarm
