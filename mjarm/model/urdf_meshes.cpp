#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/path_list.hpp"
#include "mjarm/model/preflight_internal.hpp"
#include "mjarm/model/urdf_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;
namespace {

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::vector<fs::path> split_paths(const std::optional<std::string>& list) {
  std::vector<fs::path> paths;
  if (!list) return paths;
  for (std::size_t begin = 0; begin <= list->size();) {
    const std::size_t end = std::min(list->find(kPathListSeparator, begin), list->size());
    if (end > begin) paths.emplace_back(list->substr(begin, end - begin));
    begin = end + 1;
  }
  return paths;
}

/// Finds the files that a URDF names.
class MeshFinder {
 public:
  MeshFinder(const fs::path& file, const XMLElement& robot, const LoadOptions& options)
      : folder_(fs::absolute(file).parent_path().lexically_normal()) {
    bases_ = options.package_paths;
    for (fs::path& path : split_paths(environment("ROS_PACKAGE_PATH"))) {
      bases_.push_back(std::move(path));
    }
    for (const fs::path& path : split_paths(environment("AMENT_PREFIX_PATH"))) {
      bases_.push_back(path / "share");
    }
    for (fs::path up = folder_;; up = up.parent_path()) {
      bases_.push_back(up);
      if (up == up.root_path() || up.empty()) break;
    }
    if (const XMLElement* extension = robot.FirstChildElement("mujoco")) {
      if (const XMLElement* compiler = extension->FirstChildElement("compiler")) {
        if (const char* dir = compiler->Attribute("meshdir")) mesh_folder_ = folder_ / dir;
      }
    }
  }

  /// Absolute path of an existing file; none where nothing is found.
  [[nodiscard]] std::optional<fs::path> find(std::string_view name) const {
    for (const std::string_view scheme : {"package://", "model://"}) {
      if (name.starts_with(scheme)) return in_package(name.substr(scheme.size()));
    }
    if (name.starts_with("file://")) name.remove_prefix(7);
    const fs::path path = fs::path(name);
    std::vector<fs::path> candidates = {folder_ / path};
    if (!mesh_folder_.empty()) {
      candidates.push_back(mesh_folder_ / path);
      candidates.push_back(mesh_folder_ / path.filename());
    }
    return first_file(candidates);
  }

 private:
  static std::optional<fs::path> first_file(const std::vector<fs::path>& candidates) {
    const auto found = std::find_if(candidates.begin(), candidates.end(), is_file);
    if (found == candidates.end()) return std::nullopt;
    return found->lexically_normal();
  }

  /// `rest` is `PACKAGE/path`. A base is a folder of packages or the package itself.
  [[nodiscard]] std::optional<fs::path> in_package(std::string_view rest) const {
    const std::size_t slash = rest.find('/');
    if (slash == std::string_view::npos) return std::nullopt;
    const fs::path package = rest.substr(0, slash);
    const fs::path inside = rest.substr(slash + 1);
    std::vector<fs::path> candidates;
    for (const fs::path& base : bases_) {
      candidates.push_back(fs::absolute(base) / package / inside);
      const fs::path plain = base.filename().empty() ? base.parent_path() : base;
      if (plain.filename() == package) candidates.push_back(fs::absolute(plain) / inside);
    }
    if (!mesh_folder_.empty()) {
      candidates.push_back(mesh_folder_ / inside);
      candidates.push_back(mesh_folder_ / inside.filename());
    }
    // A package in a folder of another name, as archives of robots have them.
    for (fs::path up = folder_; up != up.root_path(); up = up.parent_path()) {
      candidates.push_back(up / inside);
    }
    return first_file(candidates);
  }

  fs::path folder_;              ///< of the URDF file, absolute
  fs::path mesh_folder_;         ///< what `<mujoco><compiler meshdir>` names, or empty
  std::vector<fs::path> bases_;  ///< where packages are looked for, in order
};

/// True for the mesh formats that MuJoCo reads.
bool is_readable_format(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return ending == ".stl" || ending == ".obj" || ending == ".msh";
}

XMLElement* mesh_of(XMLElement& shape) {
  XMLElement* geometry = shape.FirstChildElement("geometry");
  return geometry != nullptr ? geometry->FirstChildElement("mesh") : nullptr;
}

/// Mesh files of one kind of shape that were left out.
struct LeftOut {
  int line = 0;  ///< of the first one
  std::vector<std::string> names;

  void add(int at, const std::string& name) {
    if (names.empty()) line = at;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  /// One line for people, where there is anything to tell.
  void warn(Msg words, const fs::path& file, std::vector<std::string>& warnings) const {
    if (names.empty()) return;
    warnings.push_back(text(words, file.string(), line, listed(names)));
  }
};

}  // namespace

Result<void> resolve_meshes(const fs::path& file, XMLElement& robot, const LoadOptions& options,
                            std::vector<std::string>& warnings) {
  const MeshFinder finder(file, robot, options);
  const std::vector<fs::path> roots = urdf_roots(file, robot, options);
  LeftOut unseen;
  LeftOut untouchable;
  for (XMLElement* link : children(robot, "link")) {
    for (const char* kind : {"visual", "collision"}) {
      for (XMLElement* shape : children(*link, kind)) {
        XMLElement* mesh = mesh_of(*shape);
        if (mesh == nullptr) continue;
        const char* name = mesh->Attribute("filename");
        if (name == nullptr) {
          return fail(urdf_error(file, *mesh, text(msg::model_attribute_missing, "filename")));
        }
        if (!is_readable_format(name)) {
          const bool visual = std::string_view(kind) == "visual";
          (visual ? unseen : untouchable).add(mesh->GetLineNum(), name);
          link->DeleteChild(shape);
          continue;
        }
        const std::optional<fs::path> path = finder.find(name);
        if (!path) return fail(urdf_error(file, *mesh, text(msg::model_no_mesh, name)));
        if (!options.allow_outside && !is_inside(*path, roots)) {
          return fail(urdf_error(file, *mesh, text(msg::guard_outside, name)));
        }
        if (auto fault = asset_fault(*path, "mesh", name)) {
          return fail(urdf_error(file, *mesh, *fault));
        }
        mesh->SetAttribute("filename", path->generic_string().c_str());
      }
    }
  }
  unseen.warn(msg::model_mesh_left_out, file, warnings);
  untouchable.warn(msg::model_collision_left_out, file, warnings);
  return {};
}

}  // namespace mjarm
