#include "apps/mjarm/install/sha256.hpp"

#include <openssl/evp.h>

#include <cerrno>
#include <cstdio>
#include <memory>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm::app {
namespace {

class Hash {
 public:
  Hash() { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }
  void add(std::string_view piece) { EVP_DigestUpdate(context_.get(), piece.data(), piece.size()); }
  std::string hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    EVP_DigestFinal_ex(context_.get(), digest, &size);
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
      text += "0123456789abcdef"[digest[i] >> 4U];
      text += "0123456789abcdef"[digest[i] & 15U];
    }
    return text;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_{EVP_MD_CTX_new()};
};

}  // namespace

std::string sha256(std::string_view content) {
  Hash hash;
  hash.add(content);
  return hash.hex();
}

Result<std::string> sha256_of_file(const std::filesystem::path& file) {
  std::FILE* stream = std::fopen(file.c_str(), "rb");
  const auto cannot_read = [&](int code) {
    return fail(Errc::system, text(msg::core_cannot_read, file.string(), system_message(code)));
  };
  if (stream == nullptr) return cannot_read(errno);
  Hash hash;
  char piece[65536];
  std::size_t count = 0;
  while ((count = std::fread(piece, 1, sizeof piece, stream)) > 0) hash.add({piece, count});
  const int code = std::ferror(stream) != 0 ? errno : 0;
  std::fclose(stream);
  if (code != 0) return cannot_read(code);
  return hash.hex();
}

}  // namespace mjarm::app
