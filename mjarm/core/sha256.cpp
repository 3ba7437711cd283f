#include "mjarm/core/sha256.hpp"

#include <openssl/evp.h>

#include "mjarm/core/file.hpp"

namespace mjarm {

std::string sha256(std::string_view content) {
  constexpr char kDigits[] = "0123456789abcdef";
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_Digest(content.data(), content.size(), digest, &size, EVP_sha256(), nullptr);
  std::string hex;
  for (unsigned int i = 0; i < size; ++i)
    hex += {kDigits[digest[i] >> 4U], kDigits[digest[i] & 15U]};
  return hex;
}

Result<std::string> sha256_of_file(const std::filesystem::path& file) {
  return read_file(file).map([](const std::string& content) { return sha256(content); });
}

}  // namespace mjarm
