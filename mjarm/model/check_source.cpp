#include <set>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/check_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;

std::string_view SourceNode::attribute(const char* name) const {
  const char* value = element->Attribute(name);
  return value != nullptr ? value : std::string_view();
}

/// What is passed down while a description is walked through.
struct Description::Surroundings {
  std::string_view section;
  std::string around;
  std::string body;
  std::string cls = "main";
};

Description::Description(const fs::path& file, bool allow_outside) : sources_(file, allow_outside) {
  for (const SourceElement& source : sources_.elements()) roots_.try_emplace(*source.file, &source);
  if (sources_.elements().empty()) return;
  const SourceElement& root = sources_.elements().front();
  is_urdf_ = std::string_view(root.element->Name()) == "robot";
  roots_.erase(*root.file);
  walk(*root.element, *root.file, {});
  for (const SourceNode& node : nodes_) {
    const bool in_body = node.section == "worldbody" || node.section == "link";
    if (in_body && node.kind() == "inertial") inertials_.try_emplace(node.body, &node);
    const bool is_joint = node.kind() == "joint" || node.kind() == "freejoint";
    if (node.section == "worldbody" && is_joint) jointed_.insert(node.body);
    if (node.section == "default") {
      defaults_[{node.cls, std::string(node.kind())}].push_back(&node);
    } else {
      named_[{std::string(node.section), std::string(node.attribute("name"))}].push_back(&node);
    }
  }
}

void Description::walk(const XMLElement& parent, const std::string& file,
                       const Surroundings& surroundings) {
  for (const XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string_view kind = e->Name();
    if (kind == "include" && !is_urdf_) {
      const XmlSources::Document* included = sources_.included_by(*e);
      const auto found = included != nullptr ? roots_.find(included->name) : roots_.end();
      if (found == roots_.end()) continue;
      const SourceElement* root = found->second;
      roots_.erase(found);  // each file once, so that this ends
      walk(*root->element, *root->file, surroundings);
      continue;
    }
    Surroundings inner = surroundings;
    if (inner.section.empty()) inner.section = kind;
    const bool is_default = inner.section == "default" && kind == "default";
    if (is_default && e->Attribute("class") != nullptr) {
      inner.cls = e->Attribute("class");
      if (inner.cls != surroundings.cls) parent_class_[inner.cls] = surroundings.cls;
    }
    nodes_.push_back({e, &file, inner.section, surroundings.around, surroundings.body, inner.cls});
    if (const char* cls = e->Attribute("childclass")) inner.cls = cls;
    const char* name = e->Attribute("name");
    if (name != nullptr) inner.around = name;
    if (kind == "body" || (is_urdf_ && kind == "link")) inner.body = name != nullptr ? name : "";
    walk(*e, file, inner);
  }
}

const SourceNode* Description::find(std::string_view section, std::string_view kind,
                                    std::string_view name) const {
  const auto found = named_.find({std::string(section), std::string(name)});
  if (found == named_.end()) return nullptr;
  for (const SourceNode* node : found->second) {
    if (kind.empty() || node->kind() == kind) return node;
  }
  return nullptr;
}

std::string Description::parent_class(const std::string& cls) const {
  const auto found = parent_class_.find(cls);
  return found != parent_class_.end() ? found->second : "";
}

std::optional<Setting> Description::setting(const SourceNode& node, const char* attribute) const {
  if (const char* own = node.element->Attribute(attribute)) return Setting{own, &node};
  std::string cls = node.cls;
  if (node.section != "default" && !node.attribute("class").empty()) cls = node.attribute("class");
  for (std::size_t steps = 0; !cls.empty() && steps <= parent_class_.size(); ++steps) {
    if (const auto found = defaults_.find({cls, std::string(node.kind())});
        found != defaults_.end()) {
      for (const SourceNode* other : found->second) {
        if (const char* value = other->element->Attribute(attribute)) return Setting{value, other};
      }
    }
    cls = parent_class(cls);
  }
  return std::nullopt;
}

Place Description::place(const SourceNode& node) const {
  const std::string kind(node.kind());
  std::string element = "<" + kind + ">";
  if (const std::string name(node.attribute("name")); !name.empty()) {
    element = "<" + kind + " \"" + name + "\">";
  } else if (node.section == "default") {
    element = "<" + kind + (kind == "default" ? " \"" + node.cls + "\">" : "> (" + node.cls + ")");
  } else if (!node.around.empty()) {
    element = text(msg::model_element_of, kind, node.around);
  }
  return {*node.file, node.element->GetLineNum(), element};
}

Place Description::root() const {
  if (sources_.elements().empty()) return {};
  const SourceElement& root = sources_.elements().front();
  return {*root.file, root.element->GetLineNum(), std::string("<") + root.element->Name() + ">"};
}

Place Description::body(const std::string& name) const {
  const SourceNode* node = is_urdf_ ? find("link", "link", name) : find("worldbody", "body", name);
  return node != nullptr ? place(*node) : Place{root().file, 0, "\"" + name + "\""};
}

Place Description::inertial(const std::string& name) const {
  const auto found = inertials_.find(name);
  if (found == inertials_.end()) return body(name);
  return {*found->second->file, found->second->element->GetLineNum(),
          text(msg::model_element_of, "inertial", name)};
}

bool Description::has_inertial(const std::string& name) const { return inertials_.count(name) > 0; }

bool Description::has_joint(const std::string& body) const { return jointed_.count(body) > 0; }

Place Description::joint(const std::string& name) const {
  const SourceNode* node =
      is_urdf_ ? find("joint", "joint", name) : find("worldbody", "joint", name);
  return node != nullptr ? place(*node) : Place{root().file, 0, "\"" + name + "\""};
}

Place Description::actuator(const std::string& name,
                            const std::vector<const char*>& attributes) const {
  const SourceNode* node = find("actuator", "", name);
  if (node == nullptr) return {root().file, 0, "\"" + name + "\""};
  Place result = place(*node);
  for (const char* attribute : attributes) {
    const std::optional<Setting> found = setting(*node, attribute);
    if (!found) continue;
    result.file = *found->node->file;
    result.line = found->node->element->GetLineNum();
    break;
  }
  return result;
}

Place Description::geom(const std::string& name, const std::string& owner,
                        const char* attribute) const {
  const SourceNode* node = name.empty() ? nullptr : find("worldbody", "geom", name);
  if (node == nullptr) return body(owner);
  Place result = place(*node);
  if (const std::optional<Setting> found = setting(*node, attribute)) {
    result.file = *found->node->file;
    result.line = found->node->element->GetLineNum();
  }
  return result;
}

Place Description::option(const char* attribute) const {
  const SourceNode* last = nullptr;
  for (const SourceNode& node : nodes_) {
    if (node.section == "option" && node.element->Attribute(attribute) != nullptr) last = &node;
  }
  return last != nullptr ? place(*last) : root();
}

}  // namespace mjarm
