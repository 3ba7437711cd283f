#include "mjarm/model/payload.hpp"

#include <mujoco/mujoco.h>

#include <cmath>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/point_mass_internal.hpp"

namespace mjarm {

Result<Model> with_payload(const Model& model, std::string_view frame, const Payload& payload) {
  if (!(payload.mass >= 0) || !std::isfinite(payload.mass) || !payload.center.allFinite()) {
    return fail(Errc::bad_input, text(msg::model_bad_mass, payload.mass));
  }
  const Result<TipFrame> found = find_frame(model, frame);
  if (!found) return fail(found.error());
  if (found->body == 0) return fail(Errc::bad_input, text(msg::model_mass_on_world, frame));
  if (payload.mass == 0) return model;
  const MjModelPtr m(mj_copyModel(nullptr, model.raw()));
  detail::add_point_mass(*m, found->body, found->X_BT * payload.center, payload.mass);
  return Model::copy_of(m.get());
}

}  // namespace mjarm
