#pragma once

#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm {

/// By how much an arm may differ from its model.
struct ModelErrors {
  double mass = 0.2;      ///< 0 <= mass < 1: each link's mass and inertia, a factor in 1 -+ mass
  double center = 0.02;   ///< [m] >= 0, the centre of mass of each link, in any direction
  double friction = 0.1;  ///< >= 0, dry friction of each joint over its largest torque
};

/// The same robot or scene, but every body that `arm` moves (what hangs at its tool with it) has
/// another mass, uniform within the bounds, its centre of mass elsewhere by `errors.center`, and
/// every joint of the arm dry friction. That is as near to Coulomb's as the time step allows: below
/// two steps MuJoCo softens it (Modelling, "Solver parameters"), so that it creeps.
/// @param rng  draws what is different; the same numbers, the same model.
/// @return bad_input where an error is out of its range.
[[nodiscard]] Result<Model> wrong_model(const Model& model, const Arm& arm,
                                        const ModelErrors& errors, Rng& rng);

/// The same robot, driven by torque: ctrl is the force of the actuator [N m or N, before the gear],
/// within the same limits of force.
[[nodiscard]] Robot with_torque_drives(const Robot& robot);

}  // namespace mjarm
