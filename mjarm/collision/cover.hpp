#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/collision/obstacles.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

namespace detail {
class SolidScene;
}

/// How a model is covered. Every default is usable as is.
struct CoverOptions {
  double bound = 0.012;  ///< [m] spheres stick out of the geoms of their link by at most this,
                         ///< 1e-5 to 1
  /// (nq,) [rad or m] where joints off the arm stand; empty: home_configuration().
  std::vector<double> qpos = {};
  ContactRules rules = {};  ///< what hangs on the tool, what may touch
  StopCheck stop = {};
};

/// A robot and what stands round it, as the fast checker takes them: made from the geoms of a model
/// by MuJoCo's rules about what collides (contype and conaffinity, parent and child, excludes,
/// explicit pairs). Pairs that are proved never to meet, in exact geometry and for all joint values
/// within the limits, are left out.
struct ModelCover {
  /// The links that the arm moves, with all that hangs on them (hand, attached things). Links whose
  /// geoms collide with different things come apart. Their spheres contain the geoms.
  SphereSet spheres;
  /// All other geoms that can meet the arm. Boxes, spheres, capsules, cylinders and planes are
  /// exact; a mesh is a polytope round its hull, a height field its columns, an ellipsoid its box.
  Obstacles scene;
  std::vector<int> standing;  ///< obstacles (by index) that belong to the robot itself: its foot
  /// The same links and obstacles as MuJoCo collides them, for FastChecker to look at what spheres
  /// cannot call free.
  std::shared_ptr<const detail::SolidScene> solids;
  double bound = 0;     ///< [m] by how much a sphere really sticks out of its link at most
  int pairs_apart = 0;  ///< pairs of links (links and obstacles) that were proved never to meet
};

/// Covers the geoms of `model` that can collide with something. A bound that needs more spheres
/// than kMaxSpheres is widened; ModelCover::bound says to what.
/// @return bad_input: one line, where the arm is not of the model, nothing on it can collide, or an
/// option is out of range; stopped() where CoverOptions::stop ended the work.
[[nodiscard]] Result<ModelCover> cover_model(const Model& model, const Arm& arm,
                                             const CoverOptions& options = {});

}  // namespace mjarm
