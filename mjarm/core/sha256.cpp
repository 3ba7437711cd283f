#include "mjarm/core/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdio>
#include <memory>

#include "mjarm/core/file.hpp"

namespace mjarm {
namespace {

/// As content comes, piece by piece.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  void add(std::string_view piece) { EVP_DigestUpdate(context_.get(), piece.data(), piece.size()); }
  [[nodiscard]] std::string hex() {
    constexpr char kDigits[] = "0123456789abcdef";
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
    std::string out;
    for (unsigned int i = 0; i < size; ++i) {
      out += {kDigits[digest[i] >> 4U], kDigits[digest[i] & 15U]};
    }
    return out;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
};

}  // namespace

std::string sha256(std::string_view content) {
  Sha256 hash;
  hash.add(content);
  return hash.hex();
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
  return hash.hex();
}

}  // namespace mjarm
