#include <sys/random.h>

#include <algorithm>
#include <cerrno>

#include "mjarm/core/hex.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_random.hpp"

namespace mjarm {

Result<std::string> secret_hex(std::size_t bytes) {
  char drawn[256];
  bytes = std::clamp<std::size_t>(bytes, 1, sizeof(drawn));
  // So few come at once or not at all; a signal may come first.
  ssize_t got = -1;
  do got = ::getrandom(drawn, bytes, 0);
  while (got < 0 && errno == EINTR);
  if (got != static_cast<ssize_t>(bytes)) {
    return fail(Errc::system, text(msg::core_no_random, system_message(errno)));
  }
  return hex({drawn, bytes});
}

}  // namespace mjarm
