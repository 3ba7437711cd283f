#include "mjarm/core/line_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/run.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_file.hpp"

namespace mjarm {
namespace {

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t") == std::string_view::npos;
}

}  // namespace

Result<LineReader> LineReader::open(const std::string& path, std::size_t longest) {
  LineReader reader;
  reader.longest_ = longest;
  reader.path_ = path;
  reader.is_stream_ = path == "-";
  reader.name_ = reader.is_stream_ ? "stdin" : path;
  if (reader.is_stream_) {
    reader.file_.reset(stdin);
    return reader;
  }
  std::error_code ignored;
  const std::filesystem::file_type type = std::filesystem::status(path, ignored).type();
  if (type == std::filesystem::file_type::not_found) {
    return fail(Errc::bad_input, text(msg::core_no_such_file, path));
  }
  if (type == std::filesystem::file_type::directory) {
    return fail(Errc::bad_input, text(msg::core_is_a_folder, path));
  }
  reader.file_.reset(open_file(path, "rb"));
  if (reader.file_ == nullptr) {
    return fail(Errc::bad_input, text(msg::core_cannot_read, path, system_message(errno)));
  }
  return reader;
}

Result<bool> LineReader::read_line() {
  current_.clear();
  for (;;) {
    const int c = std::getc(file_.get());
    if (c == EOF) break;
    if (c == '\n') return true;
    if (current_.size() >= longest_) {
      ++line_;
      return fail(Errc::bad_input,
                  text(msg::core_at_place, place(), text(msg::core_line_too_long, longest_)));
    }
    current_.push_back(static_cast<char>(c));
  }
  if (interrupted()) return fail(Errc::system, text(msg::run_interrupted));
  if (std::ferror(file_.get()) != 0) {
    return fail(Errc::system, text(msg::core_cannot_read, name_, system_message(errno)));
  }
  return !current_.empty();
}

Result<std::optional<std::string_view>> LineReader::next() {
  for (;;) {
    if (interrupted()) return fail(Errc::system, text(msg::run_interrupted));
    const Result<bool> has_line = read_line();
    if (!has_line) return fail(has_line.error());
    if (!*has_line) return std::nullopt;
    ++line_;
    std::string_view line = current_;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (line_ == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!is_blank(line)) return line;
  }
}

std::string LineReader::place() const { return name_ + ":" + std::to_string(line_); }

std::uint64_t LineReader::count_lines() const {
  std::error_code ignored;
  if (is_stream_ || !std::filesystem::is_regular_file(path_, ignored)) return 0;
  std::ifstream file(path_, std::ios::binary);
  return static_cast<std::uint64_t>(
      std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n'));
}

Result<void> read_json_lines(const std::filesystem::path& file, std::size_t longest,
                             const std::function<Result<void>(const JsonValue& object)>& take) {
  Result<LineReader> reader = LineReader::open(file.string(), longest);
  if (!reader) return fail(std::move(reader.error()));
  for (;;) {
    const auto line = reader->next();
    if (!line) return fail(line.error());
    if (!*line) return {};
    const auto taken =
        parse_json_object(**line).and_then([&](const JsonObject& object) { return take(*object); });
    if (!taken)
      return fail(taken.error().code,
                  text(msg::core_at_place, reader->place(), taken.error().what));
  }
}

}  // namespace mjarm
