#include "mjarm/core/json.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "mjarm/core/messages/json.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

constexpr double kQuatSlack = 0.02;  // two written digits, e.g. 0.71 for sqrt(1/2)

bool by_key(const JsonValue& a, const JsonValue& b) { return a.key() < b.key(); }

/// Sorts the members of an object; those of equal keys stay in order.
void sort_members(std::span<JsonValue> members) {
  constexpr std::size_t kFew = 16;
  if (members.size() > kFew) {
    std::ranges::stable_sort(members, by_key);
    return;
  }
  for (std::size_t i = 1; i < members.size(); ++i) {
    for (std::size_t k = i; k > 0 && by_key(members[k], members[k - 1]); --k) {
      std::swap(members[k], members[k - 1]);
    }
  }
}

}  // namespace

/// Takes the events of the parser. Values wait in `open_` until the list or object that they are
/// part of ends; then its entries go to `values_`, side by side.
class JsonBuilder {
 public:
  using Json = nlohmann::json;

  JsonBuilder(std::string_view text, const JsonLimits& limits)
      : limits_(limits), chars_(new char[text.size()]), end_(chars_.get()) {}

  bool null() { return add(JsonValue::Kind::null, {.whole = 0}); }
  bool boolean(bool value) { return add(JsonValue::Kind::boolean, {.boolean = value}); }
  bool number_unsigned(std::uint64_t value) {
    return add(JsonValue::Kind::whole, {.whole = value});
  }
  bool number_integer(std::int64_t value) {
    return add(JsonValue::Kind::negative, {.negative = value});
  }
  bool number_float(double value, const std::string& /*written*/) {
    return add(JsonValue::Kind::real, {.real = value});
  }
  bool string(const std::string& value) {
    if (!add(JsonValue::Kind::string, {.chars = keep(value)})) return false;
    open_.back().size_ = static_cast<std::uint32_t>(value.size());
    return true;
  }
  bool binary(const Json::binary_t& /*value*/) { return false; }
  bool key(const std::string& value) {
    key_ = keep(value);
    key_size_ = static_cast<std::uint32_t>(value.size());
    return true;
  }
  bool start_object(std::size_t /*size*/) { return start(JsonValue::Kind::object); }
  bool start_array(std::size_t /*size*/) { return start(JsonValue::Kind::list); }
  bool end_array() {
    end(open_.size());
    return true;
  }
  bool end_object() {
    const std::span<JsonValue> members = std::span(open_).subspan(starts_.back());
    sort_members(members);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const bool again = i + 1 < members.size() && members[i].key() == members[i + 1].key();
      if (again && limits_.unique_keys) {
        return stop({JsonErrc::key_twice, 0, std::string(members[i].key())});
      }
      if (!again) members[kept++] = members[i];
    }
    end(starts_.back() + kept);
    return true;
  }
  bool parse_error(std::size_t byte, const std::string& /*token*/, const Json::exception& error) {
    const bool is_syntax = dynamic_cast<const Json::parse_error*>(&error) != nullptr;
    return stop({is_syntax ? JsonErrc::syntax : JsonErrc::number_range, byte, {}});
  }

  Result<JsonObject, JsonFailure> finish() {
    if (failure_) return tl::unexpected(std::move(*failure_));
    JsonObject out;
    out.root_ = open_.front();
    if (!out.root_.is_object()) return tl::unexpected(JsonFailure{JsonErrc::no_object, 0, {}});
    out.values_ = std::move(values_);
    out.chars_ = std::move(chars_);
    const auto point_to_entries = [&](JsonValue& value) {
      if (value.kind_ < JsonValue::Kind::list) return;
      value.data_.first = out.values_.data() + value.data_.whole;
    };
    point_to_entries(out.root_);
    std::ranges::for_each(out.values_, point_to_entries);
    return out;
  }

 private:
  bool stop(JsonFailure failure) {
    failure_ = std::move(failure);
    return false;
  }
  bool add(JsonValue::Kind kind, JsonValue::Data data) {
    if (++count_ > limits_.values) return stop({JsonErrc::too_many, 0, {}});
    JsonValue& value = open_.emplace_back();
    value.kind_ = kind;
    value.data_ = data;
    value.key_ = std::exchange(key_, "");
    value.key_size_ = std::exchange(key_size_, 0);
    return true;
  }
  bool start(JsonValue::Kind kind) {
    if (std::cmp_greater_equal(starts_.size(), limits_.depth)) {
      return stop({JsonErrc::too_deep, 0, {}});
    }
    if (!add(kind, {.whole = 0})) return false;
    starts_.push_back(open_.size());
    return true;
  }
  /// The list or object that was opened last has the entries of `open_` up to `last`.
  void end(std::size_t last) {
    const auto first = open_.begin() + static_cast<std::ptrdiff_t>(starts_.back());
    JsonValue& whole = *(first - 1);
    whole.size_ = static_cast<std::uint32_t>(last - starts_.back());
    whole.data_.whole = values_.size();
    values_.insert(values_.end(), first, first + whole.size_);
    open_.erase(first, open_.end());
    starts_.pop_back();
  }
  /// Escapes only shrink, so that the room for the whole text is enough.
  const char* keep(const std::string& value) {
    char* const begin = end_;
    end_ = std::copy(value.begin(), value.end(), begin);
    return begin;
  }

  const JsonLimits& limits_;
  std::unique_ptr<char[]> chars_;
  char* end_;
  const char* key_ = "";
  std::uint32_t key_size_ = 0;
  std::size_t count_ = 0;
  std::vector<JsonValue> open_, values_;
  std::vector<std::size_t> starts_;  // of the entries of what is open, in `open_`
  std::optional<JsonFailure> failure_;
};

double JsonValue::number() const noexcept {
  switch (kind_) {
    case Kind::whole:
      return static_cast<double>(data_.whole);
    case Kind::negative:
      return static_cast<double>(data_.negative);
    case Kind::real:
      return data_.real;
    default:
      return 0;
  }
}

const JsonValue* JsonValue::find(std::string_view key) const noexcept {
  if (!is_object()) return nullptr;
  const JsonValue* const found = std::ranges::lower_bound(*this, key, {}, &JsonValue::key);
  return found != end() && found->key() == key ? found : nullptr;
}

std::string describe(const JsonFailure& failure) {
  switch (failure.code) {
    case JsonErrc::syntax:
      return text(msg::json_invalid, failure.byte);
    case JsonErrc::number_range:
      return text(msg::json_number_range);
    case JsonErrc::no_object:
      return text(msg::json_no_object);
    case JsonErrc::too_deep:
      return text(msg::json_too_deep);
    case JsonErrc::too_many:
      return text(msg::json_too_many);
    case JsonErrc::too_long:
      return text(msg::json_too_long);
    case JsonErrc::key_twice:
      return text(msg::json_key_twice, failure.key);
  }
  return {};
}

Result<JsonObject, JsonFailure> JsonObject::parse(std::string_view text, const JsonLimits& limits) {
  constexpr std::size_t kMax = std::size_t{1} << 31;  // sizes of values have 32 bits
  if (text.size() > std::min(limits.bytes, kMax)) {
    return tl::unexpected(JsonFailure{JsonErrc::too_long, 0, {}});
  }
  // The parser would take it for the end of the text.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    return tl::unexpected(JsonFailure{JsonErrc::syntax, nul + 1, {}});
  }
  JsonBuilder builder(text, limits);
  (void)nlohmann::json::sax_parse(text, &builder);  // the builder keeps what went wrong
  return builder.finish();
}

Result<JsonObject> parse_json_object(std::string_view text) {
  return JsonObject::parse(text).map_error(
      [](const JsonFailure& failure) { return Error{Errc::bad_input, describe(failure)}; });
}

Result<void> check_keys(const JsonValue& object, std::span<const std::string_view> known) {
  for (const JsonValue& member : object) {
    const std::string_view key = member.key();
    if (std::ranges::find(known, key) != known.end()) continue;
    // Short names are often next to each other without meaning each other: `v` and `a`.
    const int most = key.size() < 3 ? 0 : key.size() < 6 ? 1 : 2;
    for (const std::string_view word : known) {
      // Longer words cannot be that near, and need not be measured.
      if (key.size() > word.size() + 2 || edit_distance(key, word) > most) continue;
      return fail(Errc::bad_input, text(msg::json_misspelt_key, key, word));
    }
  }
  return {};
}

Result<std::vector<double>> number_list(const JsonValue& object, std::string_view key,
                                        std::size_t size) {
  const JsonValue* const member = object.find(key);
  if (member != nullptr) return numbers_of(*member, key, size);
  std::vector<std::string> keys;
  for (const JsonValue& entry : object) keys.emplace_back(entry.key());
  const std::optional<std::string> near = nearest_word(std::string(key), keys);
  const std::string hint = near ? text(msg::json_found_instead, *near) : std::string();
  return fail(Errc::bad_input, text(msg::json_missing, key) + hint);
}

Result<std::vector<double>> numbers_of(const JsonValue& value, std::string_view name,
                                       std::size_t size) {
  if (!value.is_list()) return fail(Errc::bad_input, text(msg::json_no_list, name, size));
  if (value.size() != size) {
    return fail(Errc::bad_input, text(msg::json_wrong_size, name, size, value.size()));
  }
  std::vector<double> values;
  values.reserve(size);
  for (const JsonValue& entry : value) {
    // Only numbers: `true`, `null` and "0.1" are faults of the program that wrote the file.
    if (!entry.is_number()) {
      return fail(Errc::bad_input, text(msg::json_no_number, name, values.size()));
    }
    values.push_back(entry.number());
  }
  return values;
}

Result<Eigen::Matrix3d> rotation_of_quat(std::span<const double> wxyz) {
  const Quat q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double norm = q.coeffs().stableNorm();
  if (!(std::abs(norm - 1) <= kQuatSlack)) {
    return fail(Errc::bad_input, text(msg::json_quat_not_unit, norm));
  }
  return to_matrix(q);
}

Result<Pose> pose_of(const JsonValue& object) {
  const Result<std::vector<double>> pos = number_list(object, "pos", 3);
  if (!pos) return fail(pos.error());
  const Result<std::vector<double>> quat = number_list(object, "quat", 4);
  if (!quat) return fail(quat.error());
  const Result<Eigen::Matrix3d> R = rotation_of_quat(*quat);
  if (!R) return fail(R.error());
  return Pose{{(*pos)[0], (*pos)[1], (*pos)[2]}, *R};
}

}  // namespace mjarm
