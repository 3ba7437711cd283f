#pragma once

#include <curl/curl.h>

#include "mjarm/core/result.hpp"

namespace mjarm::install {

/// The functions of libcurl, which is loaded when something is fetched: so no other call waits for
/// it and the thirty libraries that it needs, and no other needs it.
struct Curl {
  decltype(&::curl_global_init) global_init;
  decltype(&::curl_easy_init) easy_init;
  decltype(&::curl_easy_cleanup) easy_cleanup;
  decltype(&::curl_easy_perform) easy_perform;
  decltype(&::curl_easy_setopt) easy_setopt;
  decltype(&::curl_easy_getinfo) easy_getinfo;
  decltype(&::curl_easy_strerror) easy_strerror;
  decltype(&::curl_url) url;
  decltype(&::curl_url_cleanup) url_cleanup;
  decltype(&::curl_url_get) url_get;
  decltype(&::curl_url_set) url_set;
  decltype(&::curl_free) free;
};

/// @return not_available where this machine has no libcurl.
[[nodiscard]] Result<const Curl*> curl();

}  // namespace mjarm::install
