#pragma once

#include <optional>
#include <string>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// The body that carries the arm and hangs on nothing but a free joint, so that the robot falls and
/// is pushed back by its own motion; none where the arm stands fast.
[[nodiscard]] std::optional<std::string> floating_base(const Model& model, const Arm& arm);

}  // namespace mjarm
