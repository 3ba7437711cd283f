#pragma once

#include <string>

#include "mjarm/install/http.hpp"

namespace mjarm::install {

/// Which package index this machine uses, and how it is reached.
struct IndexSettings {
  std::string url = "https://pypi.org/simple";  ///< of the simple index; a folder a project
  HttpOptions http;
};

/// What pip would use: PIP_INDEX_URL, PIP_CERT and PIP_PROXY, else `index-url`, `cert` and `proxy`
/// of pip's configuration files, else PyPI. Certificates else from REQUESTS_CA_BUNDLE,
/// CURL_CA_BUNDLE or SSL_CERT_FILE. Files that cannot be read are passed over.
[[nodiscard]] IndexSettings index_settings();

}  // namespace mjarm::install
