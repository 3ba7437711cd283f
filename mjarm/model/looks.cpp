#include "mjarm/model/looks.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {

Result<Model> with_looks(const Model& model, const LooksChange& change) {
  const MjModelPtr copy(mj_copyModel(nullptr, model.raw()));
  for (const LooksChange::Geom& geom : change.geoms) {
    const int id = mj_name2id(copy.get(), mjOBJ_GEOM, geom.name.c_str());
    if (id < 0) return fail(Errc::bad_input, text(msg::model_no_look, geom.name));
    std::ranges::copy(geom.rgba, copy->geom_rgba + 4 * id);
  }
  for (const LooksChange::Light& light : change.lights) {
    const int id = mj_name2id(copy.get(), mjOBJ_LIGHT, light.name.c_str());
    if (id < 0) return fail(Errc::bad_input, text(msg::model_no_look, light.name));
    const Eigen::Vector3d direction = light.direction_W.normalized();
    for (int i = 0; i < 3; ++i) {
      copy->light_dir[3 * id + i] = direction[i];
      copy->light_diffuse[3 * id + i] = static_cast<float>(light.diffuse[i]);
    }
  }
  return Model::copy_of(copy.get());
}

}  // namespace mjarm
