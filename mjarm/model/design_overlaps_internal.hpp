#pragma once

#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/load_internal.hpp"

namespace mjarm {

/// The parts of a model that may overlap by design, and where its geoms belong.
struct ModelParts {
  std::vector<int> of_geom;                      ///< per geom: the number of its part
  std::function<bool(int, int)> may_count = {};  ///< whether two parts are asked at all; null: all
};
using PartPairs = std::set<std::pair<int, int>>;

/// Pairs of parts that overlap at `qpos` (nq,) and in each of many postures, drawn within the
/// ranges of all hinges and slides, by MuJoCo's rules about what collides. What touches nothing at
/// `qpos` costs no more than that look. The same model gives the same pairs.
[[nodiscard]] PartPairs always_overlapping(const mjModel* m, const mjtNum* qpos,
                                           const ModelParts& parts);

/// The same for the links of a URDF, by name. Neighbouring shapes overlap where they are joined,
/// and convex hulls of meshes more so.
[[nodiscard]] BodyPairs always_touching(const mjModel* m);

/// The same for an arm, as Arm::overlapping has it.
/// @param joints  those of the arm, base to tip, at least one.
[[nodiscard]] std::vector<DesignOverlap> design_overlaps(const mjModel* m,
                                                         const std::vector<int>& joints);

}  // namespace mjarm
