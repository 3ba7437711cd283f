#pragma once

#include <mujoco/mujoco.h>

#include <memory>

namespace mjarm::detail {

struct DeleteMjData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
struct DeleteMjModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
using MjDataPtr = std::unique_ptr<mjData, DeleteMjData>;
using MjModelPtr = std::unique_ptr<mjModel, DeleteMjModel>;

}  // namespace mjarm::detail
