#include "mjarm/session/plan_look.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/messages/panels.hpp"

namespace mjarm::session {
namespace {

constexpr double kMaxWork = 2e6;  // distances that are computed for one look

/// Distances that obstacle_neighbours() computes.
double work_of(const SphereSet& set, const Obstacles& obstacles) {
  double parts = 0;
  for (const Obstacle& solid : obstacles.solids) {
    const auto* mesh = std::get_if<MeshShape>(&solid.shape);
    const auto* field = std::get_if<HeightFieldShape>(&solid.shape);
    parts += 1;
    if (mesh != nullptr) parts += static_cast<double>(mesh->faces.size());
    if (field != nullptr) parts += static_cast<double>(field->heights.size());
  }
  for (const PointCloud& cloud : obstacles.clouds) {
    parts += static_cast<double>(cloud.points_W.size());
  }
  return parts * static_cast<double>(set.size());
}

bool has_obstacles(const Obstacles& obstacles) {
  return !obstacles.solids.empty() || !obstacles.clouds.empty();
}

/// The checker of a path without the pairs of links: some of these are near to each other in every
/// posture, and would give the whole path one colour.
FastChecker against_obstacles(const PlanSubject& subject) {
  const FastRobot& robot = subject.checker.robot();
  SphereSet set = robot.spheres();
  if (has_obstacles(subject.obstacles)) set.pairs.clear();
  Result<FastRobot> alone = FastRobot::create(robot.arm(), set);
  if (!alone) return subject.checker;  // cannot be: it was made from them
  Result<FastChecker> checker = FastChecker::create(std::move(*alone), subject.obstacles);
  return checker ? std::move(*checker) : subject.checker;
}

/// A geom by what people call it: its body, but in the world, where bodies have many geoms.
const std::string& word_of(const std::string& geom, const std::string& body) {
  return body == "world" ? geom : body;
}

}  // namespace

std::string pair_line(const NearPair& pair) {
  return text(msg::core_at_place, pair.names, text(msg::panel_mm, 1e3 * pair.distance));
}

PlanLooker::PlanLooker(const PlanSubject& subject)
    : subject_(&subject),
      obstacles_(subject.checker.solids() == nullptr ? against_obstacles(subject)
                                                     : subject.checker) {
  if (subject.checker.solids() == nullptr) return;
  exact_.emplace(
      subject.model, subject.arm,
      ExactOptions{.margin = kFarthestTold, .rules = subject.rules, .skip_neighbours = true});
}

PlanLook PlanLooker::look(std::span<const double> q) {
  return exact_ ? PlanLook{.pair = nearest_of_model(q)} : look_at_spheres(q);
}

double PlanLooker::clearance(std::span<const double> q) {
  if (!exact_) return std::min(obstacles_.clearance(q).distance, kFarthestTold);
  const std::optional<NearPair> pair = nearest_of_model(q);
  return pair ? pair->distance : kFarthestTold;
}

std::optional<NearPair> PlanLooker::nearest_of_model(std::span<const double> q) {
  const Result<CollisionReport> report = exact_->check(q);
  if (!report || !report->nearest) return {};
  const NearestPair& nearest = *report->nearest;
  return NearPair{.names = word_of(nearest.pair.geom1, nearest.pair.body1) + " - " +
                           word_of(nearest.pair.geom2, nearest.pair.body2),
                  .distance = nearest.distance,
                  .p1_W = nearest.p1_W,
                  .p2_W = nearest.p2_W};
}

PlanLook PlanLooker::look_at_spheres(std::span<const double> q) const {
  const FastRobot& robot = subject_->checker.robot();
  PlanLook out{.placed = place_spheres(robot, q)};
  const bool all = work_of(robot.spheres(), subject_->obstacles) <= kMaxWork;
  SphereClearance nearest;
  if (!all) nearest = subject_->checker.clearance(q);
  out.neighbours = obstacle_neighbours(robot.spheres(), subject_->obstacles, out.placed,
                                       all ? nullptr : &nearest);
  SphereNeighbours links = link_neighbours(robot.spheres(), out.placed);
  const auto closest = closest_pair(subject_->obstacles, out.placed, out.neighbours, links);
  if (closest) out.pair = named(out, *closest);
  if (closest && closest->to.obstacle < 0) {
    const auto obstacle = closest_pair(subject_->obstacles, out.placed, out.neighbours, {});
    if (obstacle) out.obstacle_pair = named(out, *obstacle);
  }
  if (!has_obstacles(subject_->obstacles)) out.neighbours = std::move(links);
  return out;
}

NearPair PlanLooker::named(const PlanLook& look, const ClosestPair& pair) const {
  const SphereSet& set = subject_->checker.robot().spheres();
  const auto link_of = [&](int sphere) {
    const int link = look.placed[static_cast<std::size_t>(sphere)].link;
    return set.links[static_cast<std::size_t>(link)].name;
  };
  const int obstacle = pair.to.obstacle;
  std::string other =
      obstacle < 0 ? link_of(pair.to.sphere) : obstacle_name(subject_->obstacles, obstacle);
  if (other.empty()) other = std::to_string(obstacle);
  NearPair out{.names = link_of(pair.sphere) + " - " + other,
               .distance = pair.to.distance,
               .p1_W = pair.p1_W,
               .p2_W = pair.p2_W,
               .spheres = {pair.sphere}};
  if (pair.to.sphere >= 0) out.spheres.push_back(pair.to.sphere);
  return out;
}

}  // namespace mjarm::session
