#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "mjarm/core/os_streams.hpp"

namespace mjarm {

void open_standard_streams() noexcept {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    const int opened = ::open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY);
    if (opened == -1 || opened == stream) continue;
    ::dup2(opened, stream);
    ::close(opened);
  }
}

std::vector<std::string> program_arguments(int argc, const char* const* argv) {
  return {argv + (argc > 0), argv + argc};
}

}  // namespace mjarm
