#include <set>
#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;
namespace {

/// Visual and collision shapes may bear the same name in a URDF, geoms may not: the later one goes
/// without.
void drop_repeated_shape_names(XMLElement& robot) {
  std::set<std::string> seen;
  for (XMLElement* link : children(robot, "link")) {
    for (const char* kind : {"visual", "collision"}) {
      for (XMLElement* shape : children(*link, kind)) {
        const char* name = shape->Attribute("name");
        if (name != nullptr && !seen.insert(name).second) shape->DeleteAttribute("name");
      }
    }
  }
}

/// MuJoCo's own settings for this file: keep what is seen and every fixed frame; file names are
/// absolute already. Returns the element that holds them.
XMLElement& set_compiler(tinyxml2::XMLDocument& document, XMLElement& robot) {
  XMLElement* extension = robot.FirstChildElement("mujoco");
  if (extension == nullptr) {
    extension = document.NewElement("mujoco");
    robot.InsertFirstChild(extension);
  }
  XMLElement* compiler = extension->FirstChildElement("compiler");
  if (compiler == nullptr) {
    compiler = document.NewElement("compiler");
    extension->InsertFirstChild(compiler);
  }
  compiler->DeleteAttribute("meshdir");
  for (const char* setting : {"discardvisual", "fusestatic", "strippath"}) {
    compiler->SetAttribute(setting, "false");
  }
  return *compiler;
}

/// Sorts geoms into the groups of MuJoCo's viewers: what is seen into 2 (shown), what touches into
/// 3 (hidden), or 2 where a link has no other look.
void sort_groups(mjSpec* spec) {
  std::set<const mjsBody*> has_look;
  for (int pass = 0; pass < 2; ++pass) {
    for (mjsElement* e = mjs_firstElement(spec, mjOBJ_GEOM); e; e = mjs_nextElement(spec, e)) {
      mjsGeom* geom = mjs_asGeom(e);
      const bool look = geom->contype == 0 && geom->conaffinity == 0;
      const mjsBody* body = mjs_getParent(e);
      if (pass == 0 && look) has_look.insert(body);
      if (pass == 1) geom->group = look || has_look.count(body) == 0 ? 2 : 3;
    }
  }
}

/// What MuJoCo does not take from a URDF by itself.
void finish_spec(mjSpec* spec) {
  sort_groups(spec);
  add_motors(spec);
}

Result<LoadedModel> compile_document(const fs::path& file, const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  const std::string xml = printer.CStr();
  return compile_spec({.file = file, .text = &xml}, finish_spec);
}

double limit_of(const XMLElement& joint, const char* attribute) {
  const XMLElement* limit = joint.FirstChildElement("limit");
  return limit != nullptr ? limit->DoubleAttribute(attribute, 0.0) : 0.0;
}

}  // namespace

Result<LoadedModel> load_urdf(const fs::path& file, tinyxml2::XMLDocument& document,
                              const LoadOptions& options) {
  XMLElement& robot = *document.RootElement();
  if (auto done = check_urdf(file, robot); !done) return fail(done.error());
  std::vector<std::string> warnings;
  if (auto done = resolve_meshes(file, robot, options, warnings); !done) return fail(done.error());
  drop_repeated_shape_names(robot);
  mend_inertia(file, robot, warnings);
  give_mass(file, robot, warnings);
  XMLElement& compiler = set_compiler(document, robot);

  Result<LoadedModel> loaded = compile_document(file, document);
  if (!loaded && loaded.error().what.find(text(msg::model_mj_inertia)) != std::string::npos) {
    // Inertias that no body can have are common in URDF files and matter to dynamics alone.
    warnings.push_back(text(msg::model_balanced_inertia, loaded.error().what));
    compiler.SetAttribute("balanceinertia", "true");
    loaded = compile_document(file, document);
  }
  if (!loaded) return loaded;
  if (auto done = leave_out_touching(file, *loaded); !done) return fail(std::move(done.error()));
  loaded->warnings.insert(loaded->warnings.begin(), warnings.begin(), warnings.end());
  for (const XMLElement* joint : children(std::as_const(robot), "joint")) {
    const std::string name = joint->Attribute("name");
    loaded->velocity_limits[name] = limit_of(*joint, "velocity");
    loaded->effort_limits[name] = limit_of(*joint, "effort");
  }
  return loaded;
}

}  // namespace mjarm
