#pragma once

#include <Eigen/Core>
#include <string_view>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// What hangs at the tool: a point mass, as far as its weight goes.
struct Payload {
  double mass = 0;                                   ///< [kg] >= 0; 0 = nothing
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m] centre of mass in the tool's frame

  [[nodiscard]] bool operator==(const Payload& other) const {
    return mass == other.mass && center == other.center;
  }
};

/// The same robot with a payload at a frame (site or body).
/// @return an error for a mass or a centre that is none, for a frame that is none, with the nearest
/// name, or is the world's.
[[nodiscard]] Result<Model> with_payload(const Model& model, std::string_view frame,
                                         const Payload& payload);

}  // namespace mjarm
