#include <algorithm>
#include <string_view>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/preflight_internal.hpp"
#include "mjarm/model/urdf_internal.hpp"
#include "mjarm/model/xml_sources_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;
namespace {

/// Bounds of all files of a description together; meshes are other files.
constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxMarkup = 1'000'000;  ///< elements and attributes
constexpr std::size_t kMaxFiles = 100;

Error xml_error(const std::string& name, const tinyxml2::XMLDocument& document) {
  if (document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT) {
    return {Errc::bad_input, text(msg::model_empty_file, name)};
  }
  std::string detail;
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      detail = text(msg::model_xml_mismatch);
      break;
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      detail = text(msg::model_xml_attribute);
      break;
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      detail = text(msg::model_xml_depth);
      break;
    default:
      detail = text(msg::model_xml_other);
  }
  // "Error=... ErrorID=14 (0xe) Line number=2: XMLElement name=body"
  const std::string full = document.ErrorStr();
  if (const std::size_t at = full.find("XMLElement name="); at != std::string::npos) {
    detail = text(msg::core_at_place, "<" + full.substr(at + 16) + ">", detail);
  }
  return {Errc::bad_input, text(msg::model_not_xml, name, document.ErrorLineNum(), detail)};
}

/// What can be told without looking into the XML.
std::optional<Error> check_bytes(const std::string& name, std::string_view content) {
  using namespace std::string_view_literals;
  const std::string_view head = content.substr(0, 2);
  const bool has_mark = head == "\xff\xfe"sv || head == "\xfe\xff"sv;
  if (has_mark || head == "<\0"sv || head == "\0<"sv) {
    return Error{Errc::bad_input, text(msg::guard_utf16, name)};
  }
  if (content.find('\0') != std::string_view::npos) {
    return Error{Errc::bad_input, text(msg::guard_not_text, name)};
  }
  return std::nullopt;
}

/// No document type, and nothing after the root element.
std::optional<Error> check_prolog(const std::string& name, const tinyxml2::XMLDocument& document) {
  const XMLElement* root = document.RootElement();
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    if (node->ToUnknown() != nullptr) {
      return Error{Errc::bad_input, text(msg::guard_doctype, name, node->GetLineNum())};
    }
    if (node->ToElement() != nullptr && node != root) {
      return Error{Errc::bad_input, text(msg::guard_second_root, name, node->GetLineNum(),
                                         node->ToElement()->Name())};
    }
  }
  return std::nullopt;
}

}  // namespace

XmlSources::XmlSources(const fs::path& file, bool allow_outside)
    : folder_(file.parent_path()), allow_outside_(allow_outside) {
  add({file}, nullptr);
}

void XmlSources::fail_with(std::optional<Error> error) {
  if (!fault_) fault_ = std::move(error);
}

std::optional<Error> XmlSources::read(Document& document) {
  const fs::path path = document.name;
  std::error_code ignored;
  const fs::file_type type = fs::status(path, ignored).type();
  if (type != fs::file_type::regular && type != fs::file_type::not_found &&
      type != fs::file_type::directory) {
    return Error{Errc::bad_input, text(msg::guard_special_file, document.name)};
  }
  Result<std::string> content = read_file(path, kMaxBytes - std::min(bytes_, kMaxBytes));
  if (!content) return content.error();
  document.text = std::move(*content);
  const std::string& words = document.text;
  bytes_ += words.size();
  if (auto error = check_bytes(document.name, words)) return error;
  // Counted before it is parsed: each of them takes many times its length in memory.
  markup_ += static_cast<std::size_t>(
      std::count_if(words.begin(), words.end(), [](char c) { return c == '<' || c == '='; }));
  if (markup_ > kMaxMarkup) {
    return Error{Errc::bad_input, text(msg::guard_much_markup, document.name, kMaxMarkup)};
  }
  if (document.xml.Parse(words.data(), words.size()) != tinyxml2::XML_SUCCESS) {
    return xml_error(document.name, document.xml);
  }
  if (document.xml.RootElement() == nullptr) {
    return Error{Errc::bad_input, text(msg::model_empty_file, document.name)};
  }
  return check_prolog(document.name, document.xml);
}

/// As MuJoCo looks for it; where it would find nothing, among the shipped models.
XmlSources::Place XmlSources::find(const Document& document, const std::string& name) const {
  std::error_code ignored;
  const fs::path first = folder_ / name;
  const fs::path beside = fs::path(document.name).parent_path() / name;
  if (fs::exists(first, ignored)) return {first};
  // What is included by a stand-in is looked for where that would be.
  if (fs::exists(beside, ignored)) {
    return {beside, document.stands_for.empty() ? std::string() : first.string()};
  }
  if (const auto shipped = find_shipped_include(name)) return {*shipped, first.string()};
  return {first};
}

void XmlSources::add_include(const Document& document, const XMLElement& include) {
  const char* const name = include.Attribute("file");
  const Place place = find(document, name);
  if (!allow_outside_ && !is_inside(place.path, {folder_}) && !is_shipped(place.path)) {
    return fail_with(urdf_error(document.name, include, text(msg::guard_outside, name)));
  }
  add(place, &include);
}

const XmlSources::Document* XmlSources::included_by(const XMLElement& include) const {
  for (const auto& document : documents_) {
    if (document->included_at == &include) return document.get();
  }
  return nullptr;
}

void XmlSources::add(const Place& place, const XMLElement* included_at) {
  const fs::path& path = place.path;
  for (const auto& document : documents_) {
    if (document->name == path.string()) return;  // MuJoCo refuses this; here it only must end
  }
  if (documents_.size() == kMaxFiles) {
    fail_with(Error{Errc::bad_input, text(msg::guard_many_files, path.string(), kMaxFiles)});
    return;
  }
  auto document = std::make_unique<Document>();
  document->name = path.string();
  document->included_at = included_at;
  document->stands_for = place.stands_for;
  if (std::optional<Error> error = read(*document)) {
    std::error_code ignored;
    // MuJoCo tells of an include that is missing, with its place.
    if (included_at == nullptr || fs::exists(path, ignored)) fail_with(std::move(error));
    return;
  }
  documents_.push_back(std::move(document));
  const Document& here = *documents_.back();
  std::vector<const XMLElement*> open = {here.xml.RootElement()};
  std::vector<const XMLElement*> includes;
  while (!open.empty()) {
    const XMLElement* element = open.back();
    open.pop_back();
    if (element == nullptr) continue;
    elements_.push_back({element, &here.name});
    if (element != here.xml.RootElement()) open.push_back(element->NextSiblingElement());
    open.push_back(element->FirstChildElement());
    if (element->Attribute("file") != nullptr && std::string_view(element->Name()) == "include") {
      includes.push_back(element);
    }
  }
  for (const XMLElement* include : includes) add_include(here, *include);
}

}  // namespace mjarm
