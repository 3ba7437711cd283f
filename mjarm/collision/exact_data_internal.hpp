#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <memory>

#include "mjarm/core/pose.hpp"

namespace mjarm::detail {

struct DeleteMjData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
struct DeleteMjModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
using MjDataPtr = std::unique_ptr<mjData, DeleteMjData>;
using MjModelPtr = std::unique_ptr<mjModel, DeleteMjModel>;

using MjRotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Where a geom is in the world.
[[nodiscard]] inline Pose geom_pose(const mjData& d, int geom) {
  return {Eigen::Map<const Eigen::Vector3d>(d.geom_xpos + 3 * geom),
          Eigen::Map<const MjRotation>(d.geom_xmat + 9 * geom)};
}

/// Puts a geom there until the next forward pass.
inline void put_geom(mjData& d, int geom, const Pose& X_WG) {
  Eigen::Map<Eigen::Vector3d>(d.geom_xpos + 3 * geom) = X_WG.p;
  Eigen::Map<MjRotation>(d.geom_xmat + 9 * geom) = X_WG.R;
}

}  // namespace mjarm::detail
