#include <windows.h>
// After windows.h.
#include <bcrypt.h>

#include <algorithm>

#include "mjarm/core/hex.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os_random.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {

Result<std::string> secret_hex(std::size_t bytes) {
  char drawn[256];
  bytes = std::clamp<std::size_t>(bytes, 1, sizeof(drawn));
  const NTSTATUS status =
      BCryptGenRandom(nullptr, reinterpret_cast<unsigned char*>(drawn), static_cast<ULONG>(bytes),
                      BCRYPT_USE_SYSTEM_PREFERRED_RNG);
  if (status < 0) {
    return fail(Errc::system,
                text(msg::core_no_random, "BCryptGenRandom " + std::to_string(status)));
  }
  return hex({drawn, bytes});
}

}  // namespace mjarm
