#include "mjarm/install/installed.hpp"

#include "mjarm/core/messages/install.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/user_data.hpp"
#include "mjarm/install/mesh_scene_internal.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::install {

namespace fs = std::filesystem;

Result<Installed> look_up(const MeshSet& set) {
  Installed installed;
  const Result<fs::path> data = data_folder();
  if (!data) return fail(data.error());
  installed.data = *data;
  installed.folder = mesh_folder(*data, set);
  Result<std::string> scene = find_model_file(set.robot).and_then(mesh_scene);
  if (!scene) return fail(std::move(scene.error()));
  installed.scene = std::move(*scene);
  installed.state = check_meshes(installed.folder, set, installed.scene);
  return installed;
}

Result<const MeshSet*> find_mesh_set(const std::string& robot) {
  std::vector<std::string> names;
  for (const MeshSet& set : mesh_sets()) {
    if (set.robot == robot) return &set;
    names.push_back(set.robot);
  }
  return fail(Errc::usage,
              text(msg::install_unknown, robot, listed(names)) + did_you_mean(robot, names));
}

Result<fs::path> find_mesh_scene(const std::string& robot) {
  const Result<const MeshSet*> set = find_mesh_set(robot);
  if (!set) return fail(set.error());
  const Result<Installed> installed = look_up(**set);
  if (!installed) return fail(installed.error());
  switch (installed->state.kind) {
    case InstallState::Kind::whole:
      return installed->folder / "scene.xml";
    case InstallState::Kind::absent:
      return fail(Errc::not_available, text(msg::install_not_installed, robot));
    case InstallState::Kind::damaged:
    case InstallState::Kind::outdated:
      break;
  }
  return fail(Errc::not_available, text(msg::install_mend, installed->state.problem, robot));
}

}  // namespace mjarm::install
