#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// What of a model's looks is other than its file has it; what is not named stays.
struct LooksChange {
  struct Geom {
    std::string name;
    std::array<float, 4> rgba = {0.6F, 0.6F, 0.6F, 1};  ///< each 0 to 1; over that of its material
  };
  struct Light {
    std::string name;
    Eigen::Vector3d direction_W = -Eigen::Vector3d::UnitZ();  ///< any length but zero
    Eigen::Vector3d diffuse = Eigen::Vector3d::Ones();        ///< red, green, blue, 0 to 1
  };
  std::vector<Geom> geoms = {};
  std::vector<Light> lights = {};
};

/// The same model in other colours and light, for who draws it: nothing that moves it is changed,
/// so that snapshots of the one are states of the other.
/// @return bad_input with the first name that the model does not have.
[[nodiscard]] Result<Model> with_looks(const Model& model, const LooksChange& change);

}  // namespace mjarm
