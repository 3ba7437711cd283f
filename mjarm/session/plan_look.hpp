#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/obstacles.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/session/near_spheres.hpp"

namespace mjarm::session {

/// A planned path and all that it was planned for. What it refers to outlives it.
struct PlanSubject {
  const Model& model;  ///< that is drawn
  const Arm& arm;      ///< of `model`, with its tool
  /// With the spheres; of an arm of the same joints. One that looks closer is of `model` itself:
  /// what is told and coloured are then MuJoCo's own distances, and no spheres are drawn.
  const FastChecker& checker;
  const Obstacles& obstacles;  ///< of `checker`
  const PlannedPath& path;     ///< with its trees
  std::string title;           ///< of the problem
  ContactRules rules = {};     ///< by which it was planned
};

/// Two things that are near to each other.
struct NearPair {
  std::string names;                               ///< "link - obstacle"
  double distance = 0;                             ///< [m] negative where they overlap
  Eigen::Vector3d p1_W = Eigen::Vector3d::Zero();  ///< [m] nearest points
  Eigen::Vector3d p2_W = Eigen::Vector3d::Zero();
  std::vector<int> spheres = {};  ///< that are nearest, by place in PlanLook::placed
};

/// "link - obstacle: 12.3 mm", for people.
[[nodiscard]] std::string pair_line(const NearPair& pair);

/// What an arm keeps clear of where it stands.
struct PlanLook {
  /// Spheres, where the subject is made of them, and by what they have their colours: obstacles,
  /// or links where there are none.
  std::vector<PlacedSphere> placed = {};
  SphereNeighbours neighbours = {};
  std::optional<NearPair> pair = {};
  /// The closest with an obstacle, where `pair` is of two links of spheres: these may be as near
  /// everywhere.
  std::optional<NearPair> obstacle_pair = {};
};

/// Looks at configurations of a subject, which outlives it.
class PlanLooker {
 public:
  explicit PlanLooker(const PlanSubject& subject);

  /// Whether the subject is drawn as spheres.
  [[nodiscard]] bool has_spheres() const noexcept { return !exact_.has_value(); }
  /// @param q  shape (dof,) [rad or m].
  [[nodiscard]] PlanLook look(std::span<const double> q);
  /// [m] What the arm keeps clear there, at most kFarthestTold: of obstacles where it is of
  /// spheres, else also of links that are not neighbours.
  [[nodiscard]] double clearance(std::span<const double> q);

  static constexpr double kFarthestTold = 0.3;  ///< [m]

 private:
  [[nodiscard]] PlanLook look_at_spheres(std::span<const double> q) const;
  [[nodiscard]] std::optional<NearPair> nearest_of_model(std::span<const double> q);
  [[nodiscard]] NearPair named(const PlanLook& look, const ClosestPair& pair) const;

  const PlanSubject* subject_;
  FastChecker obstacles_;  // without pairs of links
  std::optional<ExactChecker> exact_;
};

}  // namespace mjarm::session
