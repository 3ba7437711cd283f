#include "mjarm/episode/read_column.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/episode/npy_internal.hpp"

namespace mjarm::episode {
namespace {

constexpr std::size_t kBytes = 8;  // a number

/// The rows that a header of ours tells; 0 where it is none.
std::size_t rows_told(std::string_view header) {
  const std::size_t at = header.find("'shape': (");
  if (at == std::string_view::npos) return 0;
  std::size_t rows = 0;
  const char* from = header.data() + at + std::string_view("'shape': (").size();
  std::from_chars(from, header.data() + header.size(), rows);
  return rows;
}

}  // namespace

Result<NumberRows> read_column(const StoredZip& archive, const std::string& name, std::size_t width,
                               const std::string& source) {
  const std::string entry = name + ".npy";
  const Result<std::string_view> content = archive.read_checked(entry);
  if (!content) return fail(content.error());
  const auto damaged = [&] {
    return fail(Errc::bad_input, text(msg::episode_column, source, entry, width));
  };
  // A header of ours is what npy() writes for that many rows, to the byte.
  constexpr std::size_t kMaxHeader = 256;
  const std::size_t rows = rows_told(content->substr(0, kMaxHeader));
  if (rows == 0 || rows > content->size() / kBytes) return damaged();
  const std::string header = npy({}, {rows, width});
  if (!content->starts_with(header)) return damaged();
  if (content->size() - header.size() != kBytes * rows * width) return damaged();
  std::vector<double> values(rows * width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = load_little<double>(*content, header.size() + kBytes * i);
    if (!std::isfinite(values[i])) return damaged();
  }
  return NumberRows(std::move(values), width);
}

}  // namespace mjarm::episode
