#include "mjarm/model/placed_bodies.hpp"

#include <mujoco/mujoco.h>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {

Result<Model> with_bodies_at(const Model& model, std::span<const PlacedBody> places) {
  const MjModelPtr copy(mj_copyModel(nullptr, model.raw()));
  for (const PlacedBody& place : places) {
    const int id = mj_name2id(copy.get(), mjOBJ_BODY, place.body.c_str());
    if (id <= 0 || copy->body_jntnum[id] > 0 || copy->body_mocapid[id] >= 0) {
      return fail(Errc::bad_input, text(msg::model_no_place, place.body));
    }
    const Quat quat = to_quat(place.X_PB.R);
    const double turn[] = {quat.w(), quat.x(), quat.y(), quat.z()};
    for (int i = 0; i < 3; ++i) copy->body_pos[3 * id + i] = place.X_PB.p[i];
    for (int i = 0; i < 4; ++i) copy->body_quat[4 * id + i] = turn[i];
  }
  return Model::copy_of(copy.get());
}

}  // namespace mjarm
