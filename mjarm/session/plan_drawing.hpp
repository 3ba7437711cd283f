#pragma once

#include <string>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/session/plan_look.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

/// Puts the arm at `q`, shape (dof,), and what is attached to it; all else stands at home.
void place_subject(Sim& sim, const PlanSubject& subject, const JointVec& q);

/// A path by the length travelled along it [rad or m, L2].
class PathWay {
 public:
  explicit PathWay(const PlannedPath& path);

  [[nodiscard]] double length() const { return ends_.back(); }
  [[nodiscard]] JointVec at(double s) const;
  /// The edge there, from 0.
  [[nodiscard]] std::size_t edge_at(double s) const;

 private:
  std::vector<JointVec> q_;
  std::vector<double> ends_;  // of the corners
};

/// What of it is drawn.
struct PlanLayers {
  bool spheres = true;  ///< of an arm of spheres, coloured by their clearance from obstacles
  bool pair = true;     ///< the closest pair
  bool path = true;     ///< way of the tool, coloured by the arm's clearance there; corners
  bool tree = true;     ///< ways of the tool along the edges of the trees
  bool ends = true;     ///< the arm at start and goal
  bool corners = true;  ///< the arm at the corners
};

/// The arm with a tool for people to look at where it has none (no `tip`): in the middle of the
/// spheres of the last joint that are farthest from it, to 2 cm, as between the tips of a gripper.
[[nodiscard]] Arm with_tool(Arm arm, const SphereSet& spheres);

inline constexpr render::Rgba kPlanStartColor = {0.15F, 0.60F, 0.30F, 1};
inline constexpr render::Rgba kPlanGoalColor = {0.15F, 0.35F, 0.85F, 1};

/// Colour of a clearance [m]: red where there is none, amber at 1 cm, yellow at 3 cm, green at
/// 10 cm, blue from 30 cm on.
[[nodiscard]] render::Rgba clearance_color(double clearance);

/// What is drawn of a planned path on top of its model.
class PlanDrawing {
 public:
  explicit PlanDrawing(const PlanSubject& subject);

  [[nodiscard]] PlanLook look(const JointVec& q) { return looker_.look(as_span(q)); }
  [[nodiscard]] bool has_spheres() const noexcept { return looker_.has_spheres(); }
  /// @param look  where the arm stands.
  [[nodiscard]] render::Overlay overlay(const PlanLayers& layers, const PlanLook& look) const;
  [[nodiscard]] const PathWay& way() const { return way_; }
  /// Where on the way the least clearance was seen.
  [[nodiscard]] double tightest() const { return tightest_; }
  /// [m] the tool along the path, at even steps, in the world.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& tool_way() const { return tool_way_; }

 private:
  void find_tightest();
  void draw_path();
  void draw_trees();
  void draw_postures();
  void add_spheres(render::Overlay& overlay, const PlanLook& look) const;
  void add_pair(render::Overlay& overlay, const PlanLook& look, const NearPair& pair) const;

  const PlanSubject* subject_;
  PathWay way_;
  PlanLooker looker_;
  double tightest_ = 0;
  std::vector<Eigen::Vector3d> tool_way_;
  render::Overlay path_, tree_, ends_, corners_;
};

}  // namespace mjarm::session
