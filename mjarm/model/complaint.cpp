#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/model/complaint_internal.hpp"

namespace mjarm {
using tinyxml2::XMLElement;

namespace {

/// Most of MuJoCo's words that are looked at [bytes].
constexpr std::size_t kLongest = 1000;

/// Attributes of every element of MJCF, from MuJoCo's own table; elements of one name are joined.
std::map<std::string, std::set<std::string>> read_schema() {
  // Rows "   element (x)     attribute attribute"; rows without an element go on the one before.
  std::string table(std::size_t{1} << 18, '\0');
  const int length = mj_printSchema(nullptr, table.data(), static_cast<int>(table.size()), 0, 0);
  table.resize(static_cast<std::size_t>(std::max(0, length)));
  std::map<std::string, std::set<std::string>> schema;
  std::istringstream lines(table);
  std::string line;
  std::string element;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string word;
    std::string kind;
    if (line.find('(') != std::string::npos) words >> element >> kind;
    schema[element];
    while (words >> word) schema[element].insert(word);
  }
  return schema;
}

bool has_value(const XMLElement& element, const std::string& word) {
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string_view value = a->Value();
    if (word == a->Name() || word == value) return true;
    // A file is named with its folder.
    if (std::string_view(a->Name()) == "file" && !value.empty() && word.ends_with(value))
      return true;
  }
  return false;
}

bool has_name(const XMLElement& element, const std::string& name) {
  const char* own = element.Attribute("name");
  return own != nullptr && name == own;
}

/// The element that MuJoCo most likely means.
const SourceElement* find_element(const XmlSources& sources, const Complaint& complaint) {
  const SourceElement* best = nullptr;
  int best_score = 0;
  for (const SourceElement& source : sources.elements()) {
    const XMLElement& element = *source.element;
    if (!complaint.kind.empty() && complaint.kind != element.Name()) continue;
    int score = 0;
    if (!complaint.kind.empty()) score += 1;
    if (!complaint.name.empty() && has_name(element, complaint.name)) score += 2;
    if (!complaint.word.empty() && has_value(element, complaint.word)) score += 2;
    // Something other than what bears the name is at fault: a name that is not found.
    if (score > best_score) {
      best = &source;
      best_score = score;
    }
  }
  const bool only_by_kind = best_score == 1 && !(complaint.word.empty() && complaint.name.empty());
  return only_by_kind ? nullptr : best;
}

/// The element at `complaint.line` of the main file; null where several stand there.
const SourceElement* element_at_line(const XmlSources& sources, const Complaint& complaint) {
  const SourceElement* found = nullptr;
  for (const SourceElement& source : sources.elements()) {
    if (source.file != sources.elements().front().file) break;
    if (source.element->GetLineNum() != complaint.line) continue;
    if (!complaint.name.empty() && !has_name(*source.element, complaint.name)) continue;
    if (found != nullptr) return nullptr;
    found = &source;
  }
  return found;
}

/// `<kind>`, `<kind "name">`, `"name"` or nothing.
std::string label_of(const std::string& kind, const std::string& name) {
  if (name.empty()) return kind.empty() ? "" : "<" + kind + ">";
  return kind.empty() ? "\"" + name + "\"" : "<" + kind + " \"" + name + "\">";
}

std::string hint_for(const XmlSources& sources, const Complaint& complaint) {
  std::vector<std::string> known;
  std::string word = complaint.word;
  if (complaint.what.starts_with("unrecognized attribute")) {
    const auto schema = read_schema();
    const auto found = schema.find(complaint.kind);
    if (found == schema.end()) return "";
    known.assign(found->second.begin(), found->second.end());
  } else if (complaint.what.starts_with("unrecognized element")) {
    word = complaint.kind;
    for (const auto& [element, attributes] : read_schema()) known.push_back(element);
  } else if (complaint.what.find("not found") != std::string::npos ||
             complaint.what.find("unknown") != std::string::npos ||
             complaint.what.find("unrecognized name") != std::string::npos) {
    std::set<std::string> names;
    for (const SourceElement& source : sources.elements()) {
      if (const char* name = source.element->Attribute("name")) names.insert(name);
      const bool is_class = std::string_view(source.element->Name()) == "default";
      if (const char* name = is_class ? source.element->Attribute("class") : nullptr) {
        names.insert(name);
      }
    }
    names.erase(word);
    known.assign(names.begin(), names.end());
  }
  return word.empty() || known.empty() ? "" : did_you_mean(word, known);
}

}  // namespace

Error complaint_error(const XmlSources& sources, std::string_view words, bool trust_lines) {
  // Regular expressions use stack as the text grows; what tells the fault stands in front.
  Complaint complaint = take_apart(words.substr(0, kLongest));
  if (!trust_lines) complaint.line = 0;
  std::string place = sources.documents().front()->name;
  std::string kind = complaint.kind;
  if (complaint.line > 0) {
    place += ":" + std::to_string(complaint.line);
    const SourceElement* found = kind.empty() ? element_at_line(sources, complaint) : nullptr;
    if (found != nullptr) kind = found->element->Name();
  } else if (const SourceElement* found = find_element(sources, complaint)) {
    place = *found->file + ":" + std::to_string(found->element->GetLineNum());
    kind = found->element->Name();
  }
  const std::string label = label_of(kind, complaint.name);
  const std::string what = in_users_words(complaint, hint_for(sources, complaint));
  return {Errc::bad_input, label.empty() ? text(msg::model_refused, place, what)
                                         : text(msg::model_element_refused, place, label, what)};
}

}  // namespace mjarm
