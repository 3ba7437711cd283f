#include "mjarm/core/long_result.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os_file_note.hpp"
#include "mjarm/core/units.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

constexpr double kLong = 60;  // [s]
constexpr const char* kNote = "seconds";

/// [s] noted with the results at `path`; none where they are short, or gone.
std::optional<double> noted_work(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (code || !fs::exists(status)) return std::nullopt;
  // A folder keeps its note when what was in it was taken away.
  if (fs::is_directory(status) && fs::is_empty(path, code)) return std::nullopt;
  const std::optional<std::string> note = file_note(path, kNote);
  if (!note) return std::nullopt;
  const Result<double> seconds = parse_quantity(*note, Quantity::number);
  return seconds && *seconds > kLong ? std::optional(*seconds) : std::nullopt;
}

}  // namespace

double WorkClock::seconds() const noexcept {
  return std::min(1e-6 * watch_.us(), busy_seconds() - begin_);
}

Result<LongResult> LongResult::begin(const fs::path& path, const Replace& replace) {
  const bool free = replace.overwrite || path.empty();
  const std::optional<double> seconds = free ? std::nullopt : noted_work(path);
  if (!seconds) return LongResult(path, replace.work);
  return fail(Errc::usage, text(msg::core_long_result, path.string(), *seconds));
}

void LongResult::made() const noexcept {
  if (!path_.empty()) note_work(path_, work_.seconds());
}

void note_work(const fs::path& path, double seconds) noexcept {
  if (seconds > kLong) {
    set_file_note(path, kNote, std::to_string(seconds));
  } else {
    remove_file_note(path, kNote);
  }
}

}  // namespace mjarm
