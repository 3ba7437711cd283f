#include "mjarm/rl/event_log.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/policy_file.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_file.hpp"
#include "mjarm/rl/crc32c_internal.hpp"
#include "mjarm/rl/protobuf_writer_internal.hpp"

// Records: https://www.tensorflow.org/tutorials/load_data/tfrecord. Messages and their fields:
// https://github.com/tensorflow/tensorboard, tensorboard/compat/proto/event.proto, summary.proto.
namespace mjarm::rl {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileVersion = "brain.Event:2";
constexpr std::size_t kLengthSize = 8;
constexpr std::size_t kCrcSize = 4;
constexpr std::size_t kFraming = kLengthSize + 2 * kCrcSize;

std::string framed(std::string_view data) {
  std::string record;
  append_little<std::uint64_t>(record, data.size());
  append_little(record, masked_crc32c(record));
  record += data;
  append_little(record, masked_crc32c(data));
  return record;
}

/// The file's first record; it has no time, so that equal runs give equal bytes.
std::string first_record() {
  ProtobufMessage event;
  return framed(event.real64(1, 0).words(3, kFileVersion).bytes());
}

/// The data of the record at the front; none where it is cut off or damaged.
std::optional<std::string_view> record_at(std::string_view bytes) {
  if (bytes.size() < kFraming) return std::nullopt;
  const auto length = load_little<std::uint64_t>(bytes);
  if (length > bytes.size() - kFraming) return std::nullopt;
  const std::string_view data = bytes.substr(kLengthSize + kCrcSize, length);
  if (load_little<std::uint32_t>(bytes, kLengthSize) !=
          masked_crc32c(bytes.substr(0, kLengthSize)) ||
      load_little<std::uint32_t>(bytes, kLengthSize + kCrcSize + length) != masked_crc32c(data)) {
    return std::nullopt;
  }
  return data;
}

/// The step of an event as `append` writes it: after the time, of nine bytes.
std::optional<std::int64_t> step_of(std::string_view event) {
  constexpr std::size_t kTimeSize = 9;
  constexpr char kStepKey = 2 << 3;
  if (event.size() <= kTimeSize || event[kTimeSize] != kStepKey) return std::nullopt;
  std::uint64_t step = 0;
  for (std::size_t i = kTimeSize + 1, shift = 0; i < event.size() && shift < 63; ++i, shift += 7) {
    step |= static_cast<std::uint64_t>(event[i] & 0x7F) << shift;
    if ((event[i] & 0x80) == 0) return static_cast<std::int64_t>(step);
  }
  return std::nullopt;
}

/// Bytes of an event file up to the row of step `keep`; 0 where it is none.
std::size_t events_kept(std::string_view bytes, std::int64_t keep) {
  const std::string first = first_record();
  if (!bytes.starts_with(first)) return 0;
  std::size_t at = first.size();
  while (const auto event = record_at(bytes.substr(at))) {
    const auto step = step_of(*event);
    if (!step || *step > keep) break;
    at += kFraming + event->size();
  }
  return at;
}

/// Bytes of a table of numbers up to the row of step `keep`; `at` stands behind the header.
std::size_t rows_kept(std::string_view bytes, std::size_t at, std::int64_t keep) {
  for (;;) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) return at;
    const std::string_view line = bytes.substr(at, end - at);
    std::int64_t step = 0;
    const auto [last, error] = std::from_chars(line.data(), line.data() + line.size(), step);
    if (error != std::errc() || step > keep) return at;
    at = end + 1;
  }
}

/// What stands in a log that shall go on; empty for one that begins anew.
Result<std::string> old_content(const fs::path& path, std::int64_t keep) {
  std::error_code ignored;
  if (keep < 0 || !fs::exists(path, ignored)) return std::string();
  return read_file(path);
}

Error log_error(const fs::path& path, const std::string& reason) {
  return {Errc::system, text(msg::core_cannot_write, path.string(), reason)};
}

Result<void> check_row_size(const fs::path& path, std::size_t values, std::size_t columns) {
  if (values == columns) return {};
  return fail(Errc::usage, text(msg::policy_file_row_size, path.string(), values, columns));
}

}  // namespace

Result<GrowingFile> GrowingFile::open(const fs::path& path, std::uintmax_t keep) {
  GrowingFile grown;
  grown.path_ = path;
  std::error_code error;
  if (keep > 0) fs::resize_file(path, keep, error);
  if (error) return fail(log_error(path, error.message()));
  grown.file_.reset(open_file(path, keep > 0 ? "ab" : "wb"));
  if (!grown.file_) return fail(log_error(path, system_message(errno)));
  return grown;
}

Result<void> GrowingFile::append(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
      std::fflush(file_.get()) != 0) {
    return fail(log_error(path_, system_message(errno)));
  }
  return {};
}

Result<EventLog> EventLog::open(const fs::path& path, std::vector<std::string> tags,
                                std::int64_t keep) {
  const Result<std::string> old = old_content(path, keep);
  if (!old) return fail(old.error());
  const std::size_t kept = events_kept(*old, keep);
  if (kept == 0 && !first_record().starts_with(*old)) {
    return fail(Errc::bad_input, text(msg::policy_file_no_events, path.string()));
  }
  Result<GrowingFile> file = GrowingFile::open(path, kept);
  if (!file) return fail(std::move(file.error()));
  if (kept == 0) {
    if (auto done = file->append(first_record()); !done) return fail(std::move(done.error()));
  }
  return EventLog(std::move(*file), std::move(tags));
}

Result<void> EventLog::append(std::int64_t step, std::span<const double> values, double wall_time) {
  if (auto done = check_row_size(file_.path(), values.size(), tags_.size()); !done) return done;
  ProtobufMessage event, summary;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto number = static_cast<float>(values[i]);
    if (!std::isfinite(number)) continue;
    ProtobufMessage value;
    summary.message(1, value.words(1, tags_[i]).real32(2, number));
  }
  event.real64(1, wall_time).integer(2, step).message(5, summary);
  return file_.append(framed(event.bytes()));
}

Result<CsvLog> CsvLog::open(const fs::path& path, std::vector<std::string> columns,
                            std::int64_t keep) {
  std::string header = "step";
  for (const std::string& column : columns) header += "," + column;
  header += '\n';
  const Result<std::string> old = old_content(path, keep);
  if (!old) return fail(old.error());
  std::size_t kept = 0;
  if (old->starts_with(header)) {
    kept = rows_kept(*old, header.size(), keep);
  } else if (!header.starts_with(*old)) {
    return fail(Errc::bad_input, text(msg::policy_file_other_columns, path.string()));
  }
  Result<GrowingFile> file = GrowingFile::open(path, kept);
  if (!file) return fail(std::move(file.error()));
  if (kept == 0) {
    if (auto done = file->append(header); !done) return fail(std::move(done.error()));
  }
  return CsvLog(std::move(*file), columns.size());
}

Result<void> CsvLog::append(std::int64_t step, std::span<const double> values) {
  if (auto done = check_row_size(file_.path(), values.size(), columns_); !done) return done;
  std::string line = std::to_string(step);
  for (const double value : values) {
    line += ',';
    if (std::isfinite(value)) append_number(line, value);
  }
  line += '\n';
  return file_.append(line);
}

}  // namespace mjarm::rl
