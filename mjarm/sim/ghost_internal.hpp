#pragma once

#include <span>

#include "mjarm/sim/raw_internal.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// Where the tool would be if the arm stood elsewhere; the rest of the world as it is. MuJoCo's own
/// kinematics, in memory of its own, so that the simulation is not touched.
class Ghost {
 public:
  Ghost(const Model& model, const Arm& arm)
      : model_(model), arm_(arm), data_(mj_makeData(model.raw())) {}

  /// X_WT with the arm at `q` (dof,).
  [[nodiscard]] Pose tool(const Sim& sim, const JointVec& q) {
    const auto qpos = sim.qpos();
    std::copy(qpos.begin(), qpos.end(), data_->qpos);
    for (int i = 0; i < arm_.dof(); ++i) data_->qpos[arm_.joints[i].qpos] = q[i];
    mj_kinematics(model_.raw(), data_.get());
    return raw::tool_pose(*model_.raw(), *data_, arm_);
  }

 private:
  Model model_;
  Arm arm_;
  raw::Data data_;
};

}  // namespace mjarm
