#include "mjarm/core/sha256.hpp"

#include <array>
#include <cstdio>
#include <memory>

#include "mjarm/core/file.hpp"
#include "mjarm/core/hex.hpp"
#include "mjarm/core/os_file.hpp"
#include "mjarm/core/sha256_internal.hpp"

namespace mjarm {

std::string sha256(std::string_view content) {
  Sha256 hash;
  hash.add(content);
  return hex(hash.bytes());
}

std::string sha256_bytes(std::string_view content) {
  Sha256 hash;
  hash.add(content);
  return hash.bytes();
}

/// Piece by piece, as files may be large.
Result<std::string> sha256_of_file(const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> open(open_file(file, "rb"), std::fclose);
  Sha256 hash;
  std::array<char, 65536> piece;
  std::size_t count = 0;
  while (open && (count = std::fread(piece.data(), 1, piece.size(), open.get())) > 0) {
    hash.add({piece.data(), count});
  }
  // Why a file cannot be read is told by read_file().
  if (!open || std::ferror(open.get()) != 0) return read_file(file).map(sha256);
  return hex(hash.bytes());
}

}  // namespace mjarm
