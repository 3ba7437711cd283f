#include "mjarm/core/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdio>
#include <memory>

#include "mjarm/core/file.hpp"
#include "mjarm/core/hex.hpp"

namespace mjarm {
namespace {

/// As content comes, piece by piece.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  void add(std::string_view piece) { EVP_DigestUpdate(context_.get(), piece.data(), piece.size()); }
  [[nodiscard]] std::string bytes() {
    std::string digest(EVP_MAX_MD_SIZE, '\0');
    unsigned int size = 0;
    EVP_DigestFinal_ex(context_.get(), reinterpret_cast<unsigned char*>(digest.data()), &size);
    digest.resize(size);
    return digest;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
};

}  // namespace

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
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> open(std::fopen(file.c_str(), "rb"),
                                                             std::fclose);
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
