#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A body of the scene that is attached to the tool: it goes where the tool goes, and what moves
/// with the tool (hand, fingers) does not collide with it. It needs a free joint; bodies below it
/// come along.
struct AttachedBody {
  std::string body;
  Pose X_TB;  ///< in the tool frame T
};

/// What a user adds to a model's own rules about what collides.
struct ContactRules {
  std::vector<AttachedBody> attached = {};
  /// Two names each, of bodies or geoms, that may touch and overlap; a body stands for its geoms.
  std::vector<std::array<std::string, 2>> allowed = {};
};

/// Checks that every name is one of the model, every attached body has a free joint, is attached
/// once and does not carry the arm, and every pose is one.
/// @return bad_input: one line that names the faulty word, and the nearest right one.
[[nodiscard]] Result<void> check_contact_rules(const Model& model, const Arm& arm,
                                               const ContactRules& rules);

/// A body attached as it stands in the model (home_configuration()) while the arm
/// is at `q`.
/// @param q  shape (dof,) [rad or m], finite.
/// @return check_contact_rules()'s error, or one about `q`.
[[nodiscard]] Result<AttachedBody> attach_in_place(const Model& model, const Arm& arm,
                                                   const std::string& body,
                                                   std::span<const double> q);

}  // namespace mjarm
