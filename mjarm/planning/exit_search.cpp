#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "mjarm/core/rng.hpp"
#include "mjarm/planning/clear_path_internal.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kOwnSlack = 1e-4;  // [m] that an end's own clearance is not kept to
constexpr double kProbe = 1e-3;     // [rad or m] of the differences that a slope is taken from
constexpr double kClimb = 0.01;     // [rad or m, L2] of a step up the slope
constexpr double kFelt = 0.05;  // [m] a slope is that of what is no farther beyond the clearance
constexpr int kClimbs = 60;
constexpr double kFirstDraw = 0.02, kWiderDraw = 1.4;       // [rad or m, L2] radii of what is drawn
constexpr int kDraws = 32;                                  // of each radius
constexpr double kStraightShare = 2, kStraightMore = 0.05;  // an exit may become so much longer

}  // namespace

FastChecker checker_with(const ClearScene& scene, double clearance) {
  constexpr std::size_t kMaxKept = 32;
  if (scene.made != nullptr) {
    const auto known = scene.made->find(clearance);
    if (known != scene.made->end()) return known->second;
  }
  const FastRobot& robot = scene.checker.robot();
  const SphereMargins& own = robot.margins();
  auto grown = FastRobot::create(robot.arm(), robot.spheres(),
                                 {own.obstacles + clearance, own.links + clearance});
  assert(grown);  // as without the clearance
  auto checker = FastChecker::create(std::move(*grown), scene.obstacles);
  assert(checker);
  *checker = checker->looking_closer(scene.checker.solids());
  if (scene.made != nullptr && scene.made->size() < kMaxKept) {
    scene.made->emplace(clearance, *checker);
  }
  return std::move(*checker);
}

FastChecker checker_within(const ClearScene& scene, const FastChecker& wide, double clearance) {
  if (!scene.checker.solids()) return checker_with(scene, clearance);
  const SphereMargins& own = scene.checker.robot().margins();
  return wide.looking_closer(scene.checker.solids(),
                             SphereMargins{own.obstacles + clearance, own.links + clearance});
}

bool ExitSearch::is_way_out(const JointVec& from, const JointVec& to,
                            const FastChecker& narrow) const {
  PlanCounts counts;
  if (outside_joint(scene_.checker.robot().arm(), as_span(to)) >= 0) return false;
  if (!wide_.is_free(as_span(to))) return false;
  return EdgeProver(narrow, keeper_, options_, counts).is_free(as_span(from), as_span(to));
}

/// The direction in which the clearance grows fastest, of length 1; 0 where it does not.
JointVec ExitSearch::uphill(const JointVec& q) const {
  const Eigen::Index dof = q.size();
  std::vector<double> rows;
  for (Eigen::Index k = 0; k < dof; ++k) {
    for (const double side : {kProbe, -kProbe}) {
      JointVec probe = q;
      probe[k] += side;
      rows.insert(rows.end(), probe.begin(), probe.end());
    }
  }
  std::vector<SphereClearance> found(static_cast<std::size_t>(2 * dof));
  scene_.checker.clearances(rows, found, *options_.clearance + kFelt);
  JointVec slope(dof);
  for (Eigen::Index k = 0; k < dof; ++k) {
    const auto i = static_cast<std::size_t>(2 * k);
    slope[k] = found[i].distance - found[i + 1].distance;
  }
  const double length = slope.norm();
  if (!(length > 1e-9)) return JointVec::Zero(dof);
  return slope / length;
}

/// Up the slope of the clearance.
std::optional<JointVec> ExitSearch::climb(const JointVec& q, const FastChecker& narrow) const {
  JointVec at = q;
  for (int k = 0; k < kClimbs; ++k) {
    const JointVec up = uphill(at);
    if (up.isZero(0)) return std::nullopt;
    at += kClimb * up;
    if (keeper_ != nullptr && !keeper_->project({at.data(), static_cast<std::size_t>(at.size())})) {
      return std::nullopt;
    }
    if ((at - q).norm() > kFarthestExit) return std::nullopt;
    if (is_way_out(q, at, narrow)) return at;
  }
  return std::nullopt;
}

/// Anywhere, nearer than `farthest`; near places first.
std::optional<JointVec> ExitSearch::draw(const JointVec& q, double farthest,
                                         const FastChecker& narrow) const {
  Rng rng(options_.seed, 5);
  for (double radius = kFirstDraw; radius < farthest; radius *= kWiderDraw) {
    for (int k = 0; k < kDraws; ++k) {
      JointVec to(q.size());
      for (double& x : to) x = rng.normal();
      to = q + to * (radius / std::max(to.norm(), 1e-9));
      const std::span<double> row(to.data(), static_cast<std::size_t>(to.size()));
      if (keeper_ != nullptr && !keeper_->project(row)) continue;
      if (is_way_out(q, to, narrow) && (to - q).norm() <= kFarthestExit) return to;
    }
    if (is_stopped(options_.stop)) break;
  }
  return std::nullopt;
}

std::optional<Exit> ExitSearch::leave(const JointVec& q) const {
  if (wide_.is_free(as_span(q))) return Exit{q, *options_.clearance, {}};
  const double own = scene_.checker.clearance(as_span(q)).distance;
  const double kept = std::clamp(own - kOwnSlack, 0.0, *options_.clearance);
  FastChecker narrow = checker_within(scene_, wide_, kept);
  std::optional<JointVec> to = climb(q, narrow);
  const double farthest = to ? (*to - q).norm() : kFarthestExit;
  if (auto drawn = draw(q, farthest, narrow)) to = std::move(drawn);
  if (!to) return std::nullopt;
  return Exit{std::move(*to), kept, std::move(narrow)};
}

void ExitSearch::straighten(const JointVec& q, const JointVec& next, Exit& exit) const {
  if (!exit.narrow) return;
  const JointVec way = next - q;
  const double length = way.norm(), taken = (exit.q - q).norm();
  const double farthest =
      std::min({kStraightShare * taken + kStraightMore, 0.9 * length, kFarthestExit});
  PlanCounts counts;
  EdgeProver prover(wide_, keeper_, options_, counts);
  for (double at = 0.5 * taken; at < farthest; at *= 1.2) {
    const JointVec to = q + way * (at / length);
    if (!is_way_out(q, to, *exit.narrow)) continue;
    if (!prover.is_free(as_span(to), as_span(next))) continue;
    exit.q = to;
    return;
  }
}

}  // namespace mjarm::detail
