#include <algorithm>
#include <optional>

#include "mjarm/core/messages/install.hpp"
#include "mjarm/install/package_index_internal.hpp"

namespace mjarm::install {
namespace {

/// The value of the `href` that stands next at or after `at`; moves `at` behind it.
std::optional<std::string> next_link(std::string_view html, std::size_t& at) {
  at = html.find("href=", at);
  if (at == std::string_view::npos || at + 6 > html.size()) return std::nullopt;
  at += 5;
  const char quote = html[at];
  if (quote != '"' && quote != '\'') return std::string();
  const std::size_t end = html.find(quote, at + 1);
  if (end == std::string_view::npos) return std::nullopt;
  std::string link(html.substr(at + 1, end - at - 1));
  at = end + 1;
  for (std::size_t i = 0; (i = link.find("&amp;", i)) != std::string::npos; ++i) {
    link.erase(i + 1, 4);
  }
  return link;
}

}  // namespace

IndexEntry find_entry(const Page& page, std::string_view file) {
  std::size_t at = 0;
  while (std::optional<std::string> link = next_link(page.body, at)) {
    const std::size_t hash_mark = std::min(link->find('#'), link->size());
    const std::string fragment = link->substr(hash_mark);
    link->resize(hash_mark);
    const std::string path = link->substr(0, link->find('?'));
    if (path.substr(path.rfind('/') + 1) != file) continue;  // npos + 1 = 0: the whole of it
    constexpr std::string_view kHash = "#sha256=";
    const bool hashed = fragment.starts_with(kHash);
    return {resolve_link(page.url, *link), hashed ? fragment.substr(kHash.size()) : std::string()};
  }
  return {};
}

Result<std::string> find_in_index(const IndexSettings& index, const std::string& project,
                                  const std::string& file, const std::string& sha256) {
  const Result<Page> page = get_page(index.url + "/" + project + "/", index.http);
  if (!page) return fail(page.error());
  const IndexEntry entry = find_entry(*page, file);
  const std::string shown = without_password(page->url);
  if (entry.url.empty()) {
    return fail(Errc::not_available, text(msg::install_not_in_index, shown, file));
  }
  if (!entry.sha256.empty() && entry.sha256 != sha256) {
    return fail(Errc::not_available, text(msg::install_other_hash, shown, file, sha256));
  }
  return entry.url;
}

}  // namespace mjarm::install
