#include <curl/curl.h>

#include <memory>

#include "apps/mjarm/install/http.hpp"

namespace mjarm::app {
namespace {

struct FreeUrl {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};
using Url = std::unique_ptr<CURLU, FreeUrl>;

Url parse(const std::string& text) {
  Url url(curl_url());
  if (curl_url_set(url.get(), CURLUPART_URL, text.c_str(), 0) != CURLUE_OK) url.reset();
  return url;
}

std::string to_text(CURLU* url) {
  char* whole = nullptr;
  if (curl_url_get(url, CURLUPART_URL, &whole, 0) != CURLUE_OK) return {};
  std::string text(whole);
  curl_free(whole);
  return text;
}

}  // namespace

std::string resolve_link(const std::string& base, const std::string& link) {
  const Url url = parse(base);
  if (!url || curl_url_set(url.get(), CURLUPART_URL, link.c_str(), 0) != CURLUE_OK) return {};
  return to_text(url.get());
}

std::string without_password(const std::string& text) {
  const Url url = parse(text);
  if (!url) return text;
  for (const CURLUPart part : {CURLUPART_USER, CURLUPART_PASSWORD, CURLUPART_OPTIONS}) {
    curl_url_set(url.get(), part, nullptr, 0);
  }
  return to_text(url.get());
}

std::string file_url(const std::filesystem::path& file) {
  std::string url = "file://";
  for (const char c : std::filesystem::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                       (byte >= 'a' && byte <= 'z') ||
                       std::string_view("/-._~").find(c) != std::string_view::npos;
    if (plain) {
      url += c;
    } else {
      url += {'%', "0123456789ABCDEF"[byte >> 4U], "0123456789ABCDEF"[byte & 15U]};
    }
  }
  return url;
}

}  // namespace mjarm::app
