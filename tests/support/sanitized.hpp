#pragma once

namespace mjarm::support {

/// True in builds with the address or the thread sanitizer, which take many times the memory and
/// the time.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace mjarm::support
