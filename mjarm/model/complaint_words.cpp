#include <algorithm>
#include <cstdlib>
#include <regex>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/complaint_internal.hpp"

namespace mjarm {
namespace {

/// What MuJoCo says, and the message of the catalogue that says the same; its placeholders take the
/// groups of the pattern in order, then the hint.
struct Phrase {
  const char* pattern;
  Msg message;
};

constexpr Phrase kPhrases[] = {
    {"unrecognized attribute: '(.*)'", msg::model_mj_attribute},
    {"unrecognized element", msg::model_mj_element},
    {"invalid keyword: '(.*)'", msg::model_mj_keyword},
    {"required attribute missing: '(.*)'", msg::model_attribute_missing},
    {"(?:Error: )?repeated name '(.*)' in .*", msg::model_repeated_name},
    {"Error opening file '(.*)'", msg::model_mj_no_file},
    {"File '(.*)' already included", msg::model_mj_included_twice},
    {"mass and inertia of moving bodies must be larger than mjMINVAL", msg::model_mj_no_mass},
    {"inertia must satisfy A \\+ B >= C.*", msg::model_mj_inertia},
    {"size (\\d) must be positive in \\w+", msg::model_mj_size},
    {"bad format in attribute '(.*)'", msg::model_mj_bad_number},
    {"number is too large in attribute '(.*)'", msg::model_mj_large_number},
    {"attribute '(.*)' has too much data", msg::model_mj_too_much},
    {"attribute '(.*)' does not have enough data", msg::model_mj_too_little},
    {"(\\w+) '(.*)' not found in .*", msg::model_mj_not_found},
    {"unknown transmission target '(.*)' for actuator.*", msg::model_mj_target},
    {"unknown default class name '(.*)'", msg::model_mj_class},
    {"unknown element '(.*)' in .*", msg::model_mj_object},
    {"unrecognized name '(.*)' of sensorized object", msg::model_mj_object},
    {"range\\[0\\] should be smaller than range\\[1\\] in .*", msg::model_mj_range},
    {"axis too small in joint", msg::model_zero_axis},
    {"zero quaternion is not allowed", msg::model_mj_zero_quat},
    {"free joint can only be used on top level", msg::model_mj_free_joint},
    {"Could not allocate memory", msg::model_mj_memory},
};

}  // namespace

Complaint take_apart(std::string_view words) {
  static const std::regex kPlace(R"(\s*Element (name )?'([^']*)'(, id -?\d+)?(, line (-?\d+))?)");
  static const std::regex kQuoted("'([^']+)'");
  Complaint result;
  result.what = std::string(words);
  std::smatch match;
  const std::string all = result.what;
  if (std::regex_search(all, match, kPlace)) {
    result.what = match.prefix().str() + match.suffix().str();
    (match[1].matched ? result.name : result.kind) = match[2].str();
    if (match[5].matched) result.line = std::max(0, std::atoi(match[5].str().c_str()));
  }
  constexpr std::string_view kPrefixes[] = {
      "XML Error: ", "Error: ", "Schema violation: ", "engine error: "};
  for (bool again = true; again;) {
    again = false;
    for (const std::string_view prefix : kPrefixes) {
      if (!result.what.starts_with(prefix)) continue;
      result.what.erase(0, prefix.size());
      again = true;
    }
  }
  for (char& c : result.what) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  while (!result.what.empty() && result.what.back() == ' ') result.what.pop_back();
  const std::string what = result.what;
  if (std::regex_search(what, match, kQuoted)) result.word = match[1].str();
  return result;
}

std::string in_users_words(const Complaint& complaint, const std::string& hint) {
  std::smatch match;
  for (const Phrase& phrase : kPhrases) {
    if (!std::regex_match(complaint.what, match, std::regex(phrase.pattern))) continue;
    switch (match.size()) {
      case 1:
        return text(phrase.message) + hint;
      case 2:
        return text(phrase.message, match[1].str()) + hint;
      default:
        return text(phrase.message, match[1].str(), match[2].str()) + hint;
    }
  }
  return text(msg::model_mujoco_says, complaint.what) + hint;
}

}  // namespace mjarm
