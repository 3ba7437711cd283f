#include <map>
#include <set>
#include <string>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/model/check_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// The kinds of things whose names must differ, by the element; empty where names do not matter.
std::string name_space(const SourceNode& node, bool is_urdf) {
  const std::string kind(node.kind());
  const std::string_view section = node.section;
  if (is_urdf) {
    const bool on_top = section == kind && node.around.empty();
    return on_top && (kind == "link" || kind == "joint") ? kind : "";
  }
  if (section == "worldbody") {
    if (kind == "freejoint") return "joint";
    static const std::set<std::string> kKinds = {"body", "joint",  "geom",
                                                 "site", "camera", "light"};
    return kKinds.count(kind) > 0 ? kind : "";
  }
  if (section == "asset") {
    static const std::set<std::string> kKinds = {"mesh", "texture", "material", "hfield", "skin"};
    return kKinds.count(kind) > 0 ? kind : "";
  }
  if (section == "default") return kind == "default" ? "class" : "";
  static const std::set<std::string_view> kSections = {"actuator", "sensor", "equality",
                                                       "keyframe"};
  if (kSections.count(section) > 0) return kind == "plugin" ? "" : std::string(section);
  if (section == "tendon") return kind == "spatial" || kind == "fixed" ? "tendon" : "";
  return section == "contact" ? kind : "";
}

/// Name of a thing; assets without one bear that of their file.
std::string name_of(const SourceNode& node, const std::string& space) {
  if (space == "class") return node.cls == "main" ? "" : node.cls;
  const std::string name(node.attribute("name"));
  if (!name.empty() || node.section != "asset") return name;
  return fs::path(node.attribute("file")).stem().string();
}

}  // namespace

void check_names(const CheckContext& context) {
  const Description& description = context.description;
  std::map<std::pair<std::string, std::string>, const SourceNode*> seen;
  for (const SourceNode& node : description.nodes()) {
    const std::string space = name_space(node, description.is_urdf());
    const std::string name = space.empty() ? "" : name_of(node, space);
    if (name.empty()) continue;
    const auto [found, is_new] = seen.try_emplace({space, name}, &node);
    if (is_new) continue;
    const Place first = description.place(*found->second);
    context.add(CheckCode::name_doubled, Grade::error, description.place(node),
                text(msg::check_name_doubled, name,
                     fs::path(first.file).filename().string() + ":" + std::to_string(first.line)));
  }
}

namespace {

/// Everything that any element refers to, by the kind of what it refers to.
struct References {
  std::set<std::string> mesh, texture, material, cls;
};

References references_of(const Description& description) {
  References used;
  const auto refer = [](const SourceNode& node, const char* attribute, std::set<std::string>& to) {
    if (const std::string_view name = node.attribute(attribute); !name.empty()) {
      to.insert(std::string(name));
    }
  };
  for (const SourceNode& node : description.nodes()) {
    refer(node, "mesh", used.mesh);
    refer(node, "texture", used.texture);
    refer(node, "material", used.material);
    refer(node, "childclass", used.cls);
    if (node.kind() != "default") refer(node, "class", used.cls);
  }
  // A class counts as used where one inside it is.
  const std::set<std::string> direct = used.cls;
  for (std::string cls : direct) {
    for (std::size_t steps = 0; !cls.empty() && steps < 500; ++steps) {
      used.cls.insert(cls);
      cls = description.parent_class(cls);
    }
  }
  return used;
}

/// URDF: materials are named by elements of the same kind inside a visual.
void check_urdf_materials(const CheckContext& context) {
  const Description& description = context.description;
  std::set<std::string> defined;
  std::set<std::string> used;
  for (const SourceNode& node : description.nodes()) {
    if (node.kind() != "material") continue;
    const std::string name(node.attribute("name"));
    const bool is_definition = node.element->FirstChildElement() != nullptr;
    if (is_definition) defined.insert(name);
    if (node.section != "material") used.insert(name);
  }
  for (const SourceNode& node : description.nodes()) {
    if (node.kind() != "material") continue;
    const std::string name(node.attribute("name"));
    if (node.section == "material" && used.count(name) == 0) {
      context.add(CheckCode::unused_material, Grade::warning, description.place(node),
                  text(msg::check_unused_material));
    } else if (node.section == "link" && !name.empty() && defined.count(name) == 0) {
      context.add(CheckCode::material_unknown, Grade::warning, description.place(node),
                  text(msg::check_material_unknown, name));
    }
  }
}

}  // namespace

void check_unused(const CheckContext& context) {
  const Description& description = context.description;
  if (description.is_urdf()) return check_urdf_materials(context);
  const References used = references_of(description);
  const auto report = [&](const SourceNode& node, CheckCode code, Msg message) {
    // A part that several models include may well hold more than this one shows, and a class is
    // no more than a word.
    const bool is_harmless =
        *node.file != description.root().file || code == CheckCode::unused_class;
    Place place = description.place(node);
    if (node.attribute("name").empty() && node.section == "asset") {
      place.element =
          "<" + std::string(node.kind()) + " \"" + name_of(node, std::string(node.kind())) + "\">";
    }
    context.add(code, is_harmless ? Grade::note : Grade::warning, std::move(place), text(message));
  };
  for (const SourceNode& node : description.nodes()) {
    const std::string_view kind = node.kind();
    if (node.section == "default" && kind == "default" && node.cls != "main" &&
        used.cls.count(node.cls) == 0) {
      report(node, CheckCode::unused_class, msg::check_unused_class);
    }
    if (node.section != "asset") continue;
    const std::string name = name_of(node, std::string(kind));
    if (kind == "mesh" && used.mesh.count(name) == 0) {
      report(node, CheckCode::unused_mesh, msg::check_unused_mesh);
    } else if (kind == "material" && used.material.count(name) == 0) {
      report(node, CheckCode::unused_material, msg::check_unused_material);
    } else if (kind == "texture" && used.texture.count(name) == 0 &&
               node.attribute("type") != "skybox") {
      report(node, CheckCode::unused_texture, msg::check_unused_texture);
    }
  }
}

}  // namespace mjarm
