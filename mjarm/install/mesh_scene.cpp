#include <tinyxml2.h>

#include <string_view>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/install.hpp"
#include "mjarm/install/mesh_scene_internal.hpp"

namespace mjarm::install {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;
using tinyxml2::XMLNode;

constexpr int kDeepestInclude = 16;

std::string attribute(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? std::string() : value;
}

Error not_usable(const fs::path& file, const std::string& why) {
  return {Errc::bad_input, text(msg::install_bad_scene, file.string(), why)};
}

Result<void> parse(const fs::path& file, XMLDocument& document) {
  const Result<std::string> content = read_file(file);
  if (!content) return fail(content.error());
  if (document.Parse(content->data(), content->size()) != tinyxml2::XML_SUCCESS) {
    return fail(not_usable(file, document.ErrorStr()));
  }
  if (document.RootElement() == nullptr) return fail(not_usable(file, "XML"));
  return {};
}

/// Copies the children of `from` into `to`, before `place` (null: at the end).
void copy_children(const XMLNode& from, XMLNode& to, XMLNode* place) {
  for (const XMLNode* child = from.FirstChild(); child != nullptr; child = child->NextSibling()) {
    XMLNode* copy = child->DeepClone(to.GetDocument());
    XMLNode* before = place == nullptr ? to.LastChild() : place->PreviousSibling();
    if (before == nullptr) {
      to.InsertFirstChild(copy);
    } else {
      to.InsertAfterChild(before, copy);
    }
  }
}

/// Puts every included file in the place of its `<include>`.
Result<void> put_in_includes(XMLElement& parent, const fs::path& folder, int depth) {
  for (XMLElement* child = parent.FirstChildElement(); child != nullptr;) {
    XMLElement* next = child->NextSiblingElement();
    if (std::string_view(child->Name()) == "include") {
      const fs::path file = folder / attribute(*child, "file");
      XMLDocument included;
      if (depth == kDeepestInclude) return fail(not_usable(file, "<include>"));
      if (auto done = parse(file, included); !done) return done;
      if (auto done = put_in_includes(*included.RootElement(), folder, depth + 1); !done) {
        return done;
      }
      copy_children(*included.RootElement(), parent, child);
      parent.DeleteChild(child);
    } else if (auto done = put_in_includes(*child, folder, depth); !done) {
      return done;
    }
    child = next;
  }
  return {};
}

XMLElement* find_body(XMLElement& parent, const std::string& name) {
  for (XMLElement* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (child->Name() == std::string_view("body") && attribute(*child, "name") == name) {
      return child;
    }
    if (XMLElement* found = find_body(*child, name); found != nullptr) return found;
  }
  return nullptr;
}

/// Takes the drawn shapes away; the place where they stood, null where nothing follows.
XMLNode* remove_drawn_shapes(XMLElement& body) {
  XMLNode* place = nullptr;
  for (XMLElement* geom = body.FirstChildElement("geom"); geom != nullptr;) {
    XMLElement* next = geom->NextSiblingElement("geom");
    if (attribute(*geom, "class").starts_with("look")) {
      place = geom->NextSibling();
      body.DeleteChild(geom);
    }
    geom = next;
  }
  return place;
}

/// Merges `meshes.xml` into the scene.
Result<void> put_in_meshes(const XMLElement& meshes, const fs::path& file, XMLElement& scene) {
  for (const XMLElement* part = meshes.FirstChildElement(); part != nullptr;
       part = part->NextSiblingElement()) {
    if (part->Name() != std::string_view("body")) {
      scene.InsertEndChild(part->DeepClone(scene.GetDocument()));
      continue;
    }
    const std::string name = attribute(*part, "name");
    XMLElement* body = find_body(scene, name);
    if (body == nullptr) return fail(not_usable(file, "<body name=\"" + name + "\">"));
    XMLNode* place = remove_drawn_shapes(*body);
    copy_children(*part, *body, place);
  }
  return {};
}

}  // namespace

Result<std::string> mesh_scene(const fs::path& scene) {
  const fs::path folder = scene.parent_path(), overlay = folder / "meshes.xml";
  XMLDocument document, meshes;
  if (auto done = parse(scene, document); !done) return fail(std::move(done.error()));
  if (auto done = parse(overlay, meshes); !done) return fail(std::move(done.error()));
  auto done = put_in_includes(*document.RootElement(), folder, 0).and_then([&] {
    return put_in_meshes(*meshes.RootElement(), overlay, *document.RootElement());
  });
  if (!done) return fail(std::move(done.error()));
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return std::string(printer.CStr());
}

}  // namespace mjarm::install
