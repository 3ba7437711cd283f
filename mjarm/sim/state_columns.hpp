#pragma once

#include <string>
#include <vector>

#include "mjarm/core/units.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// What one number of a model's state or command is.
struct StateColumn {
  /// Of its joint, actuator or sensor, then which of several numbers: `box x`, `box qw`, `wrist 2`.
  /// A joint without a name has that of its body, if it is the only one there; else the kind and
  /// the number stand for it: `joint 3`.
  std::string name;
  std::string unit;                      ///< empty where it has none, or nobody can tell
  Quantity quantity = Quantity::number;  ///< how a user may write it
};

/// The numbers of a model, each list in MuJoCo's order.
struct StateColumns {
  std::vector<StateColumn> qpos;     ///< (nq,)
  std::vector<StateColumn> qvel;     ///< (nv,)
  std::vector<StateColumn> ctrl;     ///< (nu,) of position servos as their joint, else a number
  std::vector<StateColumn> sensors;  ///< (nsensordata,)
};

[[nodiscard]] StateColumns state_columns(const Model& model);

}  // namespace mjarm
