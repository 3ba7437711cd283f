#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "mjarm/core/pose.hpp"
#include "mjarm/model/arm.hpp"

/// What the sources of this room share of MuJoCo.
namespace mjarm::raw {

struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Data = std::unique_ptr<mjData, DeleteData>;

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
using OwnModel = std::unique_ptr<mjModel, DeleteModel>;

/// Pose of the arm's tool frame in the world, from kinematics that are up to date.
[[nodiscard]] Pose tool_pose(const mjModel& m, const mjData& d, const Arm& arm);

/// Name of a joint's dof, for messages; "dof 7" where the joint has none.
[[nodiscard]] std::string dof_name(const mjModel& m, int dof);
/// The same for an entry of qpos.
[[nodiscard]] std::string qpos_name(const mjModel& m, int index);
/// Geom name, else the name of its body, else "geom 7"; "flex" for what is no geom.
[[nodiscard]] std::string geom_name(const mjModel& m, int geom);

/// True where MuJoCo counted a bad number in the state or its change.
/// @param warnings  all mjNWARNING of one world.
[[nodiscard]] bool unstable(const mjWarningStat* warnings);
/// What went wrong at `time` [s] in a world that is unstable, naming the joint.
[[nodiscard]] std::string instability(const mjModel& m, const mjWarningStat* warnings, double time);

}  // namespace mjarm::raw
