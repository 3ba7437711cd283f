// Fuzzes the reader of safetensors files; what it takes comes back the same when it is written.
#include <cstdint>
#include <string_view>

#include "mjarm/rl/safetensors.hpp"
#include "tests/fuzz/finding.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mjarm;
  const auto set = rl::parse_safetensors({reinterpret_cast<const char*>(data), size}, "f");
  if (!set) {
    fuzz::check_refusal(set.error());
    return 0;
  }
  const auto bytes = rl::to_safetensors(*set, "f");
  if (!bytes) fuzz::finding("it cannot be written", bytes.error().what);
  const auto again = rl::parse_safetensors(*bytes, "f");
  if (!again) fuzz::finding("what was written is refused", again.error().what);
  // By bytes: numbers that are none are equal to nothing.
  const auto second = rl::to_safetensors(*again, "f");
  if (!second || *second != *bytes) fuzz::finding("it reads something else", *bytes);
  return 0;
}
