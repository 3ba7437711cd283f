#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/model/preflight_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{200} << 20;  ///< [bytes]
constexpr double kMaxPixels = 1 << 26;

/// The first bytes of a file; shorter where the file is.
struct Head {
  std::array<char, 84> bytes{};
  std::size_t size = 0;

  /// Whole number of four bytes, as the machines that MuJoCo runs on write it.
  [[nodiscard]] double whole(std::size_t at) const {
    std::int32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }
  [[nodiscard]] double unsigned_whole(std::size_t at) const {
    const double value = whole(at);
    return value < 0 ? value + 4294967296.0 : value;
  }
  /// The same in the order of networks.
  [[nodiscard]] double network_whole(std::size_t at) const {
    double value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
  }
};

Head read_head(const fs::path& path) {
  Head head;
  std::ifstream file(path, std::ios::binary);
  file.read(head.bytes.data(), static_cast<std::streamsize>(head.bytes.size()));
  head.size = static_cast<std::size_t>(file.gcount());
  return head;
}

std::string ending_of(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); });
  return ending;
}

/// What the first bytes of a file promise: its length [bytes], or its pixels.
struct Promise {
  double bytes = 0;
  double pixels = 0;
  bool empty = false;  ///< a mesh without faces
};

Promise promise_of(const Head& head, std::string_view element, std::string_view ending) {
  const bool is_mesh = element == "mesh" || element == "flexcomp";
  if (is_mesh && ending == ".stl") {
    if (head.size < 84) return {.bytes = 84};
    const double faces = head.unsigned_whole(80);
    return {.bytes = 84 + 50 * faces, .empty = faces == 0};
  }
  if (element == "mesh" && ending == ".msh" && head.size >= 16 && head.bytes[0] != '$') {
    double numbers = 0;
    const std::array<double, 4> each = {3, 3, 2, 3};
    for (std::size_t i = 0; i < 4; ++i) {
      // A count below zero cannot be kept by any file.
      numbers += each[i] * (head.whole(4 * i) < 0 ? 1e10 : head.whole(4 * i));
    }
    return {.bytes = 16 + 4 * numbers, .empty = numbers == 0};
  }
  if (ending == ".png" && head.size >= 24 && std::memcmp(head.bytes.data(), "\x89PNG", 4) == 0) {
    return {.pixels = head.network_whole(16) * head.network_whole(20)};
  }
  if (element == "hfield" && ending != ".png" && head.size >= 8) {
    const double rows = head.unsigned_whole(0);
    const double columns = head.unsigned_whole(4);
    return {.bytes = 8 + 4 * rows * columns};
  }
  return {};
}

}  // namespace

std::optional<std::string> asset_fault(const fs::path& path, std::string_view element,
                                       std::string_view shown) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (error || type == fs::file_type::not_found) return std::nullopt;
  if (type != fs::file_type::regular) return text(msg::guard_not_a_file, shown);
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return std::nullopt;
  if (size > kLargestFile) return text(msg::guard_large_file, shown, size, kLargestFile);
  const Head head = read_head(path);
  const Promise promise = promise_of(head, element, ending_of(path));
  if (promise.bytes > static_cast<double>(size)) {
    const bool is_text = std::memcmp(head.bytes.data(), "solid", 5) == 0;
    if (is_text && ending_of(path) == ".stl") return text(msg::guard_text_stl, shown);
    return text(msg::guard_file_lies, shown, promise.bytes, size);
  }
  if (promise.empty) return text(msg::guard_empty_mesh, shown);
  if (promise.pixels > kMaxPixels) {
    return text(msg::guard_too_big, shown, promise.pixels, kMaxPixels);
  }
  return std::nullopt;
}

}  // namespace mjarm
