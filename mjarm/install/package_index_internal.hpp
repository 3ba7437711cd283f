#pragma once

#include <string>
#include <string_view>

#include "mjarm/install/http.hpp"
#include "mjarm/install/index_settings.hpp"

namespace mjarm::install {

/// Where `file` lies according to a page of a simple package index.
struct IndexEntry {
  std::string url;     ///< absolute; empty where the page does not list the file
  std::string sha256;  ///< as the page says; empty where it does not
};

/// Looks `file` up on a page of HTML, as every index serves it (PEP 503); never throws, whatever
/// the page.
[[nodiscard]] IndexEntry find_entry(const Page& page, std::string_view file);

/// Address of one file of `project`, whose hash must be `sha256` where the index tells one.
[[nodiscard]] Result<std::string> find_in_index(const IndexSettings& index,
                                                const std::string& project, const std::string& file,
                                                const std::string& sha256);

}  // namespace mjarm::install
