#include "apps/mjarm/cli/print.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "mjarm/core/utf8.hpp"

namespace mjarm::app {

void print_lines(std::string_view lines) {
  std::string out;
  out.reserve(lines.size());
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    out += printable(lines.substr(0, end));
    if (end < lines.size()) out += '\n';
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  std::fwrite(out.data(), 1, out.size(), stdout);
}

}  // namespace mjarm::app
