#pragma once

#include <span>
#include <string>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// A body without joints, and where it stands.
struct PlacedBody {
  std::string body;
  Pose X_PB;  ///< in the frame of its parent
};

/// The same scene with some of its furniture elsewhere: a cabinet, the foot of a button. What hangs
/// on it comes along, with its joints as they are. States of the one are states of the other.
/// @return bad_input with the first name that is no body, or that of one with joints.
[[nodiscard]] Result<Model> with_bodies_at(const Model& model, std::span<const PlacedBody> places);

}  // namespace mjarm
