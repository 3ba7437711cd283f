#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "mjarm/model/arm.hpp"

namespace mjarm::detail {

/// Which bodies of a model an arm moves.
struct ArmBodies {
  ArmBodies(const mjModel& m, const Arm& arm);

  std::vector<int> addresses;  ///< of the arm's joints in qpos
  std::vector<int> pieces;     ///< per body: how many joints of the arm move it
  bool matches = true;         ///< the arm is one of this model
};

/// The keyframe `home`, else the initial configuration; shape (nq,).
[[nodiscard]] std::vector<double> rest_configuration(const mjModel& m);

/// Name of a geom; BODY[k], the k-th (from 0) of its body, where it has none.
[[nodiscard]] std::string geom_name(const mjModel& m, int geom);
/// Name of a body; empty where it has none.
[[nodiscard]] std::string body_name(const mjModel& m, int body);

}  // namespace mjarm::detail
