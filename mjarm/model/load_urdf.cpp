#include <set>
#include <utility>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/design_overlaps_internal.hpp"
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

Result<LoadedModel> compile_document(const XmlSources& files, const LoadOptions& options,
                                     const tinyxml2::XMLDocument& document,
                                     const BodyPairs& apart) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  const std::string xml = printer.CStr();
  const auto finish = [&](mjSpec* spec) { finish_urdf(spec, apart); };
  Result<LoadedModel> loaded = compile_spec({.files = files,
                                             .text = &xml,
                                             .trusted = options.trusted,
                                             .prepare = finish,
                                             .looks = options.looks});
  if (loaded) loaded->urdf_text = xml;
  return loaded;
}

/// Compiles once more where links touch that do so in every posture, with a line in `warnings`.
Result<LoadedModel> without_constant_contacts(const XmlSources& files, const LoadOptions& options,
                                              const tinyxml2::XMLDocument& document,
                                              LoadedModel loaded,
                                              std::vector<std::string>& warnings) {
  const BodyPairs apart = always_touching(loaded.model.get());
  if (apart.empty()) return loaded;
  std::string words;
  for (const auto& [a, b] : apart)
    words += (words.empty() ? "" : text(msg::core_comma)) + a + " - " + b;
  const std::string& file = files.documents().front()->name;
  warnings.push_back(text(msg::model_always_touching, file, words));
  return compile_document(files, options, document, apart);
}

double limit_of(const XMLElement& joint, const char* attribute) {
  const XMLElement* limit = joint.FirstChildElement("limit");
  return limit != nullptr ? limit->DoubleAttribute(attribute, 0.0) : 0.0;
}

}  // namespace

Result<LoadedModel> load_urdf(const XmlSources& files, const LoadOptions& options) {
  // A second copy, to be changed: messages need the file as written.
  const XmlSources::Document& main = *files.documents().front();
  const fs::path file = main.name;
  tinyxml2::XMLDocument document;
  document.Parse(main.text.data(), main.text.size());
  XMLElement& robot = *document.RootElement();
  if (auto done = validate_urdf(file, robot); !done) return fail(done.error());
  std::vector<std::string> warnings;
  if (auto done = resolve_meshes(file, robot, options, warnings); !done) return fail(done.error());
  drop_repeated_shape_names(robot);
  mend_inertia(file, robot, warnings);
  give_mass(file, robot, warnings);
  XMLElement& compiler = set_compiler(document, robot);

  Result<LoadedModel> loaded = compile_document(files, options, document, {});
  if (!loaded && loaded.error().what.find(text(msg::model_mj_inertia)) != std::string::npos) {
    // Inertias that no body can have are common in URDF files and matter to dynamics alone.
    warnings.push_back(text(msg::model_balanced_inertia, loaded.error().what));
    compiler.SetAttribute("balanceinertia", "true");
    loaded = compile_document(files, options, document, {});
  }
  if (!loaded) return loaded;
  loaded = without_constant_contacts(files, options, document, std::move(*loaded), warnings);
  if (!loaded) return loaded;
  loaded->warnings.insert(loaded->warnings.begin(), warnings.begin(), warnings.end());
  for (const XMLElement* joint : children(std::as_const(robot), "joint")) {
    const std::string name = joint->Attribute("name");
    loaded->velocity_limits[name] = limit_of(*joint, "velocity");
    loaded->effort_limits[name] = limit_of(*joint, "effort");
  }
  return loaded;
}

}  // namespace mjarm
