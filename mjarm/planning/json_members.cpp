#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/planning/json_members_internal.hpp"

namespace mjarm::detail {
namespace {

using nlohmann::json;

constexpr int kDeepest = 32;
constexpr double kQuatSlack = 0.02;  // two written digits, e.g. 0.71 for sqrt(1/2)

/// Brackets that are open at once at most; those inside strings do not count.
int nesting(std::string_view line) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return deepest;
}

std::vector<std::string> member_names(const json& object) {
  std::vector<std::string> names;
  for (const auto& item : object.items()) names.push_back(item.key());
  return names;
}

}  // namespace

void JsonDeleter::operator()(const json* json) const { delete json; }

Result<JsonObject> parse_json_object(std::string_view line) {
  if (nesting(line) > kDeepest) return fail(Errc::bad_input, text(msg::app_json_too_deep));
  json value;
  try {
    value = json::parse(line);
  } catch (const json::parse_error& error) {
    return fail(Errc::bad_input, text(msg::app_json_invalid, error.byte));
  } catch (const json::exception&) {  // a number beyond the range of double
    return fail(Errc::bad_input, text(msg::app_json_number_range));
  }
  if (!value.is_object()) return fail(Errc::bad_input, text(msg::app_json_no_object));
  return JsonObject(new json(std::move(value)));
}

Result<std::vector<double>> number_list(const json& object, const std::string& key,
                                        std::size_t size) {
  const auto member = object.find(key);
  if (member == object.end()) {
    const std::optional<std::string> near = nearest_word(key, member_names(object));
    const std::string hint = near ? text(msg::app_json_found_instead, *near) : std::string();
    return fail(Errc::bad_input, text(msg::app_json_missing, key) + hint);
  }
  return numbers_of(*member, key, size);
}

Result<std::vector<double>> numbers_of(const json& value, const std::string& name,
                                       std::size_t size) {
  if (!value.is_array()) return fail(Errc::bad_input, text(msg::app_json_no_list, name, size));
  if (value.size() != size) {
    return fail(Errc::bad_input, text(msg::app_json_wrong_size, name, size, value.size()));
  }
  std::vector<double> values;
  for (const json& entry : value) {
    // Only numbers: `true`, `null` and "0.1" are faults of the program that wrote the file.
    if (!entry.is_number()) {
      return fail(Errc::bad_input, text(msg::app_json_no_number, name, values.size()));
    }
    values.push_back(entry.get<double>());
  }
  return values;
}

Result<Eigen::Matrix3d> rotation_of_quat(const std::vector<double>& wxyz) {
  const Quat q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double norm = q.coeffs().stableNorm();
  if (!(std::abs(norm - 1) <= kQuatSlack)) {
    return fail(Errc::bad_input, text(msg::app_quat_not_unit, norm));
  }
  return to_matrix(q);
}

}  // namespace mjarm::detail
