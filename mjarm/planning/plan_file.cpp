#include "mjarm/planning/plan_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/json.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/region_json_internal.hpp"

namespace mjarm {
namespace {

constexpr double kUnitSlack = 1e-6;                         // relative
constexpr std::size_t kMaxPlanFile = std::size_t{1} << 28;  // [bytes]

std::string indexed(const char* list, std::size_t i) {
  return std::string(list) + '[' + std::to_string(i) + ']';
}

Result<double> number_at(const JsonValue& object, const char* key) {
  const JsonValue* const found = object.find(key);
  if (found == nullptr) return fail(Errc::bad_input, text(msg::json_missing, key));
  if (!found->is_number()) return fail(Errc::bad_input, text(msg::planning_verify_no_number, key));
  return found->number();
}

/// One that a path can keep.
Result<double> length_at(const JsonValue& object, const char* key) {
  Result<double> value = number_at(object, key);
  if (!value || (*value >= 0 && *value <= kMaxClearanceAsked)) return value;
  return fail(Errc::bad_input, text(msg::planning_verify_bad_length, key, kMaxClearanceAsked));
}

Result<void> read_rows(const JsonValue& rows, std::size_t dof, GivenPath& out) {
  if (!rows.is_list()) return fail(Errc::bad_input, text(msg::planning_verify_no_rows));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Result<std::vector<double>> row = numbers_of(rows[i], indexed("path", i), dof);
    if (!row) return fail(std::move(row.error()));
    out.rows.push_back(std::move(*row));
  }
  return {};
}

Result<GivenCertificate> certificate_of(const JsonValue& entry) {
  if (!entry.is_object()) return fail(Errc::bad_input, text(msg::json_no_object));
  GivenCertificate out;
  const std::pair<const char*, double*> members[] = {
      {"step", &out.step}, {"clearance", &out.clearance}, {"t", &out.t}};
  for (const auto& [key, target] : members) {
    const Result<double> value = number_at(entry, key);
    if (!value) return fail(value.error());
    *target = *value;
  }
  constexpr std::string_view kKnown[] = {"step", "clearance", "t", "kept", "pair"};
  if (Result<void> fine = check_keys(entry, kKnown); !fine) return fail(std::move(fine.error()));
  if (entry.contains("kept")) {
    const Result<double> kept = length_at(entry, "kept");
    if (!kept) return fail(kept.error());
    out.kept = *kept;
  }
  const JsonValue* const pair = entry.find("pair");
  if (pair == nullptr) return out;
  if (!pair->is_list() || pair->size() != 2 || !(*pair)[0].is_string() || !(*pair)[1].is_string()) {
    return fail(Errc::bad_input, text(msg::planning_verify_no_pair));
  }
  out.pair = {(*pair)[0].string(), (*pair)[1].string()};
  return out;
}

Result<void> read_certificates(const JsonValue& list, GivenPath& out) {
  if (!list.is_list()) return fail(Errc::bad_input, text(msg::planning_verify_no_certificates));
  out.certificate.emplace();
  for (std::size_t i = 0; i < list.size(); ++i) {
    Result<GivenCertificate> entry = certificate_of(list[i]);
    if (!entry) {
      return fail(Errc::bad_input,
                  text(msg::core_at_place, indexed("certificate", i), entry.error().what));
    }
    out.certificate->push_back(std::move(*entry));
  }
  return {};
}

Result<void> read_tilt(const JsonValue& entry, GivenPath& out) {
  if (!entry.is_object())
    return fail(Errc::bad_input, text(msg::core_at_place, "tilt", text(msg::json_no_object)));
  GivenTilt tilt;
  const std::pair<const char*, double*> numbers[] = {{"limit", &tilt.limit},
                                                     {"largest", &tilt.largest}};
  for (const auto& [key, target] : numbers) {
    const Result<double> value = number_at(entry, key);
    if (!value)
      return fail(value.error().code, text(msg::core_at_place, "tilt", value.error().what));
    *target = *value;
  }
  const std::pair<const char*, std::vector<double>*> members[] = {{"tool", &tilt.tool},
                                                                  {"world", &tilt.world}};
  for (const auto& [key, target] : members) {
    Result<std::vector<double>> axis = number_list(entry, key, 3);
    if (!axis) return fail(axis.error().code, text(msg::core_at_place, "tilt", axis.error().what));
    *target = std::move(*axis);
  }
  constexpr std::string_view kKnown[] = {"limit", "largest", "tool", "world"};
  const Result<void> fine = check_keys(entry, kKnown);
  if (!fine) return fail(fine.error().code, text(msg::core_at_place, "tilt", fine.error().what));
  const auto is_unit = [](const std::vector<double>& v) {
    return std::abs(std::hypot(v[0], v[1], v[2]) - 1) < kUnitSlack;
  };
  const bool is_sound = tilt.limit > 0 && tilt.limit < std::numbers::pi / 2 && tilt.largest >= 0 &&
                        tilt.largest <= tilt.limit * (1 + kUnitSlack) && is_unit(tilt.tool) &&
                        is_unit(tilt.world);
  if (!is_sound) return fail(Errc::bad_input, text(msg::planning_verify_bad_tilt));
  out.tilt = std::move(tilt);
  return {};
}

/// A list of strings, or none.
Result<void> read_words(const JsonValue& entry, const char* key, std::vector<std::string>& out) {
  const JsonValue* const list = entry.find(key);
  if (list == nullptr) return {};
  const auto is_word = [](const JsonValue& word) { return word.is_string(); };
  if (!list->is_list() || !std::all_of(list->begin(), list->end(), is_word)) {
    return fail(Errc::bad_input, text(msg::planning_verify_no_words, key));
  }
  for (const JsonValue& word : *list) out.push_back(word.string());
  return {};
}

Result<void> read_entry(const JsonValue& entry, std::size_t dof, GivenPath& out) {
  if (entry.is_list()) return read_rows(entry, dof, out);
  if (!entry.is_object()) return fail(Errc::bad_input, text(msg::planning_verify_no_rows));
  constexpr std::string_view kKnown[] = {"ok",           "path",
                                         "us",           "simplify_us",
                                         "cost",         "reason",
                                         "hold",         "allow",
                                         "tilt",         "certificate",
                                         "clearance",    "goal_region",
                                         "within",       "possible_clearance",
                                         "start_region", "same_posture"};
  if (Result<void> fine = check_keys(entry, kKnown); !fine) return fail(std::move(fine.error()));
  const JsonValue* const ok = entry.find("ok");
  if (ok != nullptr && !ok->is_boolean()) {
    return fail(Errc::bad_input, text(msg::planning_verify_no_bool, "ok"));
  }
  if (ok != nullptr && !ok->boolean()) return {};
  const JsonValue* const path = entry.find("path");
  if (path == nullptr) return fail(Errc::bad_input, text(msg::json_missing, "path"));
  if (Result<void> read = read_rows(*path, dof, out); !read) return read;
  if (entry.contains("cost")) {
    const Result<double> cost = number_at(entry, "cost");
    if (!cost) return fail(cost.error());
    out.cost = *cost;
  }
  if (entry.contains("clearance")) {
    const Result<double> clearance = length_at(entry, "clearance");
    if (!clearance) return fail(clearance.error());
    out.clearance = *clearance;
  }
  if (Result<void> read = read_words(entry, "hold", out.rules.hold); !read) return read;
  if (Result<void> read = read_words(entry, "allow", out.rules.allow); !read) return read;
  if (const JsonValue* const tilt = entry.find("tilt"); tilt != nullptr) {
    if (Result<void> read = read_tilt(*tilt, out); !read) return read;
  }
  if (const JsonValue* const within = entry.find("within"); within != nullptr) {
    Result<GivenRegion> region = detail::read_kept_region(*within);
    if (!region)
      return fail(region.error().code, text(msg::core_at_place, "within", region.error().what));
    out.within = std::move(*region);
  }
  const JsonValue* const certificate = entry.find("certificate");
  return certificate == nullptr ? Result<void>() : read_certificates(*certificate, out);
}

}  // namespace

Result<std::vector<GivenPath>> read_plan_file(const std::string& path, std::size_t dof) {
  const Result<std::string> content = read_file(path, kMaxPlanFile);
  if (!content) return fail(content.error());
  const Result<JsonObject> object = parse_json_object(*content);
  if (!object)
    return fail(object.error().code, text(msg::core_at_place, path, object.error().what));
  std::vector<GivenPath> out;
  for (const JsonValue& entry : **object) {
    GivenPath given;
    given.id = entry.key();
    if (Result<void> read = read_entry(entry, dof, given); !read) {
      return fail(read.error().code,
                  text(msg::planning_verify_in_path, path, given.id, read.error().what));
    }
    out.push_back(std::move(given));
  }
  return out;
}

}  // namespace mjarm
