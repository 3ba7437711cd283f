#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/install/curl_internal.hpp"

namespace mjarm::install {
namespace {

#if defined(_WIN32)
constexpr const char* kLibrary = "libcurl-x64.dll";
#else
constexpr const char* kLibrary = "libcurl.so.4";
#endif

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(library_symbol(library, name));
}

Result<Curl> load() {
  const Result<void*> library = open_library(kLibrary);
  if (!library) {
    return fail(Errc::not_available, text(msg::install_no_curl, library.error().what));
  }
  Curl curl{};
  find(*library, "curl_global_init", curl.global_init);
  find(*library, "curl_easy_init", curl.easy_init);
  find(*library, "curl_easy_cleanup", curl.easy_cleanup);
  find(*library, "curl_easy_perform", curl.easy_perform);
  find(*library, "curl_easy_setopt", curl.easy_setopt);
  find(*library, "curl_easy_getinfo", curl.easy_getinfo);
  find(*library, "curl_easy_strerror", curl.easy_strerror);
  find(*library, "curl_url", curl.url);
  find(*library, "curl_url_cleanup", curl.url_cleanup);
  find(*library, "curl_url_get", curl.url_get);
  find(*library, "curl_url_set", curl.url_set);
  find(*library, "curl_free", curl.free);
  // The youngest of them: libcurl 7.62. PROTOCOLS_STR came with 7.85.
  if (curl.url_set == nullptr || curl.global_init(CURL_GLOBAL_DEFAULT) != CURLE_OK) {
    return fail(Errc::not_available, text(msg::install_no_curl, kLibrary));
  }
  return curl;
}

}  // namespace

Result<const Curl*> curl() {
  static const Result<Curl> loaded = load();
  if (!loaded) return fail(loaded.error());
  return &*loaded;
}

}  // namespace mjarm::install
