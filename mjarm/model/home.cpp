#include "mjarm/model/home.hpp"

#include <mujoco/mujoco.h>

namespace mjarm {

int home_keyframe(const mjModel_* model) noexcept {
  const int named = mj_name2id(model, mjOBJ_KEY, "home");
  return named < 0 && model->nkey == 1 ? 0 : named;
}

std::span<const double> home_configuration(const mjModel_* model) noexcept {
  const int key = home_keyframe(model);
  const double* const qpos = key < 0 ? model->qpos0 : model->key_qpos + key * model->nq;
  return {qpos, static_cast<std::size_t>(model->nq)};
}

}  // namespace mjarm
