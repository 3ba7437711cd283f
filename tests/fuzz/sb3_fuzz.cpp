// Fuzzes the reader of Stable-Baselines3's files: a zip with JSON and PyTorch's zip with a pickle.
// After each change the checksums are mended, which would refuse nearly all of them.
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "mjarm/rl/sb3_zip.hpp"
#include "tests/fuzz/finding.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number value = 0;
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Where the local header of a member stands; npos where there is none.
std::size_t local_header(std::string_view bytes, std::string_view name) {
  constexpr std::size_t kSize = 30;
  for (std::size_t at = bytes.find("PK\3\4"); at != std::string_view::npos;
       at = bytes.find("PK\3\4", at + 1)) {
    if (bytes.substr(at).size() > kSize && bytes.substr(at + kSize).starts_with(name)) return at;
  }
  return std::string_view::npos;
}

/// Those of members that are not packed. An inner zip is whole before the directory of the outer
/// one, so that its checksums are right when they are summed up there.
void mend_checksums(std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (std::size_t at = bytes.find("PK\1\2"); at != std::string_view::npos;
       at = bytes.find("PK\1\2", at + 1)) {
    if (at + 46 > size) return;
    const std::string_view name = bytes.substr(at + 46, number_at<std::uint16_t>(bytes, at + 28));
    const std::size_t local = local_header(bytes, name);
    if (local == std::string_view::npos) continue;
    const std::size_t begin =
        local + 30 + name.size() + number_at<std::uint16_t>(bytes, local + 28);
    if (begin > size) continue;
    const std::string_view content = bytes.substr(begin, number_at<std::uint32_t>(bytes, at + 20));
    const auto crc = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()));
    std::memcpy(data + at + 16, &crc, sizeof crc);
    std::memcpy(data + local + 14, &crc, sizeof crc);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  const std::size_t changed = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 8 != 0) mend_checksums(data, changed);
  return changed;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mjarm;
  const auto set = rl::parse_sb3_zip({reinterpret_cast<const char*>(data), size}, "f.zip");
  if (!set) fuzz::check_refusal(set.error());
  return 0;
}
