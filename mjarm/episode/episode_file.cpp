#include "mjarm/episode/episode_file.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <system_error>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/episode/archive_internal.hpp"
#include "mjarm/episode/options_json_internal.hpp"

namespace mjarm::episode {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 30;
constexpr JsonLimits kLimits{
    .depth = 16, .values = std::size_t{1} << 20, .bytes = std::size_t{1} << 24};
constexpr const char* kPrefix = "episode_";
constexpr const char* kEnding = ".zip";

Result<EpisodeHead> read_head(std::string_view json, const std::string& source) {
  const auto parsed = JsonObject::parse(json, kLimits);
  if (!parsed) {
    return fail(Errc::bad_input,
                text(msg::episode_json, source, "episode.json", describe(parsed.error())));
  }
  const JsonValue* schema = (*parsed)->find("schema");
  if (schema == nullptr || schema->string() != kSchema) {
    const std::string found = schema != nullptr ? schema->string() : "";
    return fail(Errc::bad_input, text(msg::episode_schema, source, found, kSchema));
  }
  const JsonValue* task = (*parsed)->find("task");
  if (task != nullptr && task->is_string() && task->string() == kLedTask) {
    return fail(Errc::bad_input, text(msg::episode_by_hand, source));
  }
  FieldReader fields(**parsed, source);
  EpisodeHead head{.options = fields.options(),
                   .number = fields.whole("number", kMaxNumber),
                   .success = fields.boolean("success"),
                   .reason = fields.string("reason"),
                   .model_hash = fields.string("model_hash")};
  if (!fields.fault().empty()) return fail(Errc::bad_input, fields.fault());
  if (auto fits = check(head.options); !fits) {
    return fail(Errc::bad_input,
                text(msg::episode_json, source, "episode.json", fits.error().what));
  }
  return head;
}

void sort_by_number(std::vector<fs::path>& files) {
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    const std::string x = a.filename().string(), y = b.filename().string();
    return x.size() != y.size() ? x.size() < y.size() : x < y;
  });
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kPrefix) && name.ends_with(kEnding)) out.push_back(entry.path());
  }
  sort_by_number(out);
  return out;
}

}  // namespace

Result<EpisodeFile> read_episode(const fs::path& file) {
  Result<std::string> bytes = read_file(file, kMaxBytes);
  if (!bytes) return fail(std::move(bytes.error()));
  const std::string source = file.string();
  const Result<StoredZip> zip = StoredZip::open(*bytes, source);
  if (!zip) return fail(zip.error());
  const Result<std::string_view> json = zip->read_checked("episode.json");
  if (!json) return fail(json.error());
  Result<EpisodeHead> head = read_head(*json, source);
  if (!head) return fail(std::move(head.error()));
  return EpisodeFile{std::move(*head), std::move(*bytes)};
}

std::string episode_name(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  constexpr std::size_t kDigits = 6;
  const std::string zeros(kDigits - std::min(kDigits, digits.size()), '0');
  return kPrefix + zeros + digits + kEnding;
}

std::vector<fs::path> succeeded_files(const fs::path& folder) { return files_in(folder); }

std::vector<fs::path> failed_files(const fs::path& folder) { return files_in(folder / "failed"); }

std::vector<fs::path> episode_files(const fs::path& folder) {
  std::vector<fs::path> out = succeeded_files(folder);
  const std::vector<fs::path> failed = failed_files(folder);
  out.insert(out.end(), failed.begin(), failed.end());
  sort_by_number(out);
  return out;
}

Result<std::string> first_difference(std::string_view kept, std::string_view made,
                                     const std::string& source) {
  if (kept == made) return std::string();
  const Result<StoredZip> before = StoredZip::open(kept, source), now = StoredZip::open(made, "");
  if (!before) return fail(before.error());
  if (!now) return fail(now.error());
  for (const std::string_view name : now->names()) {
    if (!before->contains(name)) return std::string(name);
    const Result<std::string_view> a = before->read(name), b = now->read(name);
    if (!a) return fail(a.error());
    if (*a == *b) continue;
    const auto at = std::ranges::mismatch(*a, *b).in1 - a->begin();
    return std::string(name) + ", byte " + std::to_string(at + 1);
  }
  for (const std::string_view name : before->names()) {
    if (!now->contains(name)) return std::string(name);
  }
  return std::string("archive");
}

Result<std::string> replay(Studio& studio, const EpisodeFile& file, const std::string& source,
                           const StopCheck& stop) {
  if (file.head.model_hash != studio.model_hash()) {
    return fail(Errc::bad_input,
                text(msg::episode_other_model, source, file.head.model_hash, studio.model_hash()));
  }
  const Result<Episode> again = studio.make(file.head.number, stop);
  if (!again) return fail(again.error());
  return first_difference(file.bytes, again->bytes, source);
}

}  // namespace mjarm::episode
