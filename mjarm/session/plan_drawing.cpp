#include "mjarm/session/plan_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/render/overlay_shapes.hpp"
#include "mjarm/session/posture_rods.hpp"

namespace mjarm::session {
namespace {

constexpr render::Rgba kCornerColor = {0.15F, 0.15F, 0.18F, 1};
constexpr render::Rgba kUnknownColor = {0.55F, 0.60F, 0.66F, 1};
constexpr float kEndPosture = 0.6F;  // how dense they are
constexpr float kCornerPosture = 0.2F;
constexpr std::size_t kMaxPostures = 8;  // of corners
constexpr float kSphere = 0.45F;
constexpr float kPairSphere = 0.85F;
constexpr double kDrawnPathStep = 0.02;  // [rad or m, L2] between places of the path
constexpr double kPathPieces = 300;      // at most
constexpr double kTreeStep = 0.15;       // [rad or m, L2] between places of an edge of a tree
constexpr double kTreePieces = 12'000;   // of all edges, about
constexpr double kPairRed = 0.01;        // [m]

render::Rgba with_alpha(render::Rgba color, float alpha) {
  color.a = alpha;
  return color;
}

}  // namespace

void place_subject(Sim& sim, const PlanSubject& subject, const JointVec& q) {
  sim.reset_home();
  sim.place(subject.arm, as_span(q));
  const Pose X_WT = fk(subject.arm, as_span(q));
  for (const AttachedBody& one : subject.rules.attached) sim.place_free(one.body, X_WT * one.X_TB);
}

PathWay::PathWay(const PlannedPath& path) : q_(path.q), ends_{0} {
  for (std::size_t i = 1; i < q_.size(); ++i)
    ends_.push_back(ends_.back() + (q_[i] - q_[i - 1]).norm());
}

std::size_t PathWay::edge_at(double s) const {
  if (ends_.size() < 3) return 0;
  const auto found = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, s);
  return static_cast<std::size_t>(found - ends_.begin()) - 1;
}

JointVec PathWay::at(double s) const {
  const std::size_t i = edge_at(s);
  if (i + 1 >= q_.size()) return q_.back();
  const double length = ends_[i + 1] - ends_[i];
  const double share = length > 0 ? std::clamp((s - ends_[i]) / length, 0.0, 1.0) : 0;
  return q_[i] + share * (q_[i + 1] - q_[i]);
}

Arm with_tool(Arm arm, const SphereSet& spheres) {
  constexpr double kTip = 0.02;  // [m]
  if (!arm.tip.empty()) return arm;
  double max = 0;
  const auto each = [&](auto&& visit) {
    for (const LinkSpheres& link : spheres.links) {
      if (link.joint != arm.dof() - 1) continue;
      for (const Sphere& sphere : link.spheres) visit(sphere.center);
    }
  };
  each([&](const Eigen::Vector3d& p) { max = std::max(max, p.norm()); });
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  each([&](const Eigen::Vector3d& p) {
    if (p.norm() < max - kTip) return;
    sum += p;
    ++count;
  });
  if (count > 0) arm.X_JT.p = sum / count;
  return arm;
}

render::Rgba clearance_color(double clearance) {
  struct Stop {
    double at;
    render::Rgba color;
  };
  static constexpr std::array<Stop, 5> kStops{{{0, {0.84F, 0.10F, 0.12F, 1}},
                                               {0.01, {0.96F, 0.50F, 0.12F, 1}},
                                               {0.03, {0.97F, 0.82F, 0.22F, 1}},
                                               {0.10, {0.30F, 0.68F, 0.33F, 1}},
                                               {0.30, {0.20F, 0.48F, 0.80F, 1}}}};
  if (!(clearance > 0)) return kStops.front().color;
  for (std::size_t i = 1; i < kStops.size(); ++i) {
    if (clearance > kStops[i].at) continue;
    const render::Rgba &a = kStops[i - 1].color, &b = kStops[i].color;
    const auto share =
        static_cast<float>((clearance - kStops[i - 1].at) / (kStops[i].at - kStops[i - 1].at));
    return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b), 1};
  }
  return kStops.back().color;
}

PlanDrawing::PlanDrawing(const PlanSubject& subject)
    : subject_(&subject), way_(subject.path), looker_(subject) {
  draw_path();
  draw_trees();
  draw_postures();
}

/// Where the certificates saw the least clearance.
void PlanDrawing::find_tightest() {
  const PlannedPath& path = subject_->path;
  double least = std::numeric_limits<double>::infinity(), end = 0;
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    const double length = (path.q[i] - path.q[i - 1]).norm();
    if (i <= path.proof.size() && path.proof[i - 1].nearest.distance < least) {
      least = path.proof[i - 1].nearest.distance;
      tightest_ = end + path.proof[i - 1].nearest_t * length;
    }
    end += length;
  }
}

void PlanDrawing::draw_path() {
  find_tightest();
  double least = std::numeric_limits<double>::infinity();
  const double step = std::max(kDrawnPathStep, way_.length() / kPathPieces);
  const int pieces = std::max(1, static_cast<int>(std::ceil(way_.length() / step)));
  constexpr double kShades = 24;
  std::map<int, render::OverlaySegments> shades;  // pieces of one colour are one
  for (int i = 0; i <= pieces; ++i) {
    tool_way_.push_back(fk(subject_->arm, as_span(way_.at(way_.length() * i / pieces))).p);
    if (i == 0) continue;
    const double middle = way_.length() * (i - 0.5) / pieces;
    const double clearance = looker_.clearance(as_span(way_.at(middle)));
    // The certificates of a model are of its spheres where these tell that it is free.
    if (!looker_.has_spheres() && clearance < least) {
      least = clearance;
      tightest_ = middle;
    }
    const double shade = std::round(kShades * std::sqrt(std::clamp(clearance, 0.0, 0.3) / 0.3));
    render::OverlaySegments& segments = shades[static_cast<int>(shade)];
    segments.width = 0.012;
    segments.look = render::LineLook::tube;
    segments.color = clearance_color(0.3 * (shade / kShades) * (shade / kShades));
    segments.ends_W.insert(segments.ends_W.end(), tool_way_.end() - 2, tool_way_.end());
  }
  for (auto& [shade, segments] : shades) path_.segments.push_back(std::move(segments));
  const std::vector<JointVec>& q = subject_->path.q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const bool end = i == 0 || i + 1 == q.size();
    path_.spheres.push_back({.p_W = fk(subject_->arm, as_span(q[i])).p,
                             .radius = end ? 0.018 : 0.011,
                             .color = i == 0 ? kPlanStartColor
                                      : end  ? kPlanGoalColor
                                             : kCornerColor});
  }
}

void PlanDrawing::draw_trees() {
  double length = 0, edges = 0;
  const auto each_edge = [this](auto&& visit) {
    for (std::size_t t = 0; t < subject_->path.trees.size(); ++t) {
      const SearchTree& tree = subject_->path.trees[t];
      for (std::size_t i = 0; i < tree.q.size(); ++i) {
        if (tree.parents[i] >= 0)
          visit(t, tree.q[static_cast<std::size_t>(tree.parents[i])], tree.q[i]);
      }
    }
  };
  each_edge([&](std::size_t, const JointVec& a, const JointVec& b) {
    length += (b - a).norm();
    edges += 1;
  });
  if (edges == 0) return;
  const double step = std::max(kTreeStep, length / std::max(kTreePieces - edges, 1.0));
  const std::array colors{kPlanStartColor, kPlanGoalColor};
  for (std::size_t t = 0; t < subject_->path.trees.size(); ++t) {
    tree_.segments.push_back({.ends_W = {},
                              .width = 0.003,
                              .color = with_alpha(colors[t % 2], 0.8F),
                              .look = render::LineLook::thin});
  }
  each_edge([&](std::size_t t, const JointVec& a, const JointVec& b) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / step)));
    Eigen::Vector3d before = fk(subject_->arm, as_span(a)).p;
    for (int k = 1; k <= pieces; ++k) {
      const JointVec q = a + (b - a) * k / pieces;
      const Eigen::Vector3d p_W = fk(subject_->arm, as_span(q)).p;
      std::vector<Eigen::Vector3d>& ends_W = tree_.segments[t].ends_W;
      ends_W.insert(ends_W.end(), {before, p_W});
      before = p_W;
    }
  });
}

/// Rods rather than the arm once more: it would hide what it passes.
void PlanDrawing::draw_postures() {
  const auto add = [this](render::Overlay& overlay, const JointVec& q, const render::Rgba& color,
                          double radius) {
    add_posture_rods(overlay, subject_->arm, q, color, radius);
  };
  const std::vector<JointVec>& q = subject_->path.q;
  add(ends_, q.front(), with_alpha(kPlanStartColor, kEndPosture), 0.016);
  add(ends_, q.back(), with_alpha(kPlanGoalColor, kEndPosture), 0.016);
  // Evenly some of them, where there are many.
  const std::size_t corners = q.size() - 2, max = std::min(corners, kMaxPostures);
  for (std::size_t i = 0; i < max; ++i) {
    add(corners_, q[1 + i * corners / max], with_alpha(kCornerColor, kCornerPosture), 0.012);
  }
}

void PlanDrawing::add_spheres(render::Overlay& overlay, const PlanLook& look) const {
  for (std::size_t i = 0; i < look.placed.size(); ++i) {
    const auto& neighbour = look.neighbours[i];
    const render::Rgba color = neighbour ? clearance_color(neighbour->distance) : kUnknownColor;
    overlay.spheres.push_back({.p_W = look.placed[i].p_W,
                               .radius = look.placed[i].radius,
                               .color = with_alpha(color, kSphere)});
  }
}

void PlanDrawing::add_pair(render::Overlay& overlay, const PlanLook& look,
                           const NearPair& pair) const {
  const render::Rgba color = with_alpha(clearance_color(pair.distance), kPairSphere);
  for (const int sphere : pair.spheres) {
    const PlacedSphere& placed = look.placed[static_cast<std::size_t>(sphere)];
    overlay.spheres.push_back({.p_W = placed.p_W, .radius = 1.01 * placed.radius, .color = color});
  }
  render::add_closest_pair(overlay, pair.p1_W, pair.p2_W, pair.distance, kPairRed);
}

render::Overlay PlanDrawing::overlay(const PlanLayers& layers, const PlanLook& look) const {
  render::Overlay out;
  if (layers.tree) append(out, tree_);
  if (layers.path) append(out, path_);
  if (layers.ends) append(out, ends_);
  if (layers.corners) append(out, corners_);
  if (layers.spheres) add_spheres(out, look);
  if (layers.pair && look.pair) add_pair(out, look, *look.pair);
  if (layers.pair && look.obstacle_pair) add_pair(out, look, *look.obstacle_pair);
  return out;
}

}  // namespace mjarm::session
