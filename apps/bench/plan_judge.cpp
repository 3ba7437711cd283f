#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/bench/plan.hpp"

namespace mjarm::app {
namespace {

constexpr double kSpacing = 0.005;  // [rad or m, L2]
constexpr double kEndTol = 1e-4;    // [rad or m] of a joint

/// Centres of the spheres of every link in the world.
using Centres = std::vector<std::vector<Eigen::Vector3d>>;

Centres centres_at(const PlanSet& set, const JointVec& q) {
  std::vector<Pose> moved;  // frames of the joints in the world
  Pose X_WP;
  for (std::size_t i = 0; i < set.arm.joints.size(); ++i) {
    const ArmJoint& joint = set.arm.joints[i];
    const double value = q[static_cast<Eigen::Index>(i)];
    Pose motion;
    if (joint.type == JointType::hinge) {
      motion.R = Eigen::AngleAxisd(value, joint.axis).toRotationMatrix();
    } else {
      motion.p = value * joint.axis;
    }
    X_WP = X_WP * joint.X_PJ * motion;
    moved.push_back(X_WP);
  }
  Centres centres;
  for (const LinkSpheres& link : set.spheres.links) {
    const Pose X_WJ = link.joint < 0 ? Pose() : moved[static_cast<std::size_t>(link.joint)];
    std::vector<Eigen::Vector3d>& placed = centres.emplace_back();
    for (const Sphere& sphere : link.spheres) placed.push_back(X_WJ * sphere.center);
  }
  return centres;
}

/// Least clearance of an arm from obstacles and from itself [m].
struct Clearance {
  double obstacle = std::numeric_limits<double>::infinity();
  double self = std::numeric_limits<double>::infinity();
};

/// Points of a cloud from left to right, so that few are looked at for a sphere.
struct SortedCloud {
  std::vector<Eigen::Vector3d> points;
  double radius;
};

std::vector<SortedCloud> sorted_clouds(const Obstacles& obstacles) {
  std::vector<SortedCloud> sorted;
  for (const PointCloud& cloud : obstacles.clouds) {
    std::vector<Eigen::Vector3d>& points =
        sorted.emplace_back(SortedCloud{cloud.points_W, cloud.radius}).points;
    std::sort(points.begin(), points.end(),
              [](const auto& a, const auto& b) { return a.x() < b.x(); });
  }
  return sorted;
}

/// [m] from a ball to the points that it may overlap; infinite where there are none.
double distance_to(const SortedCloud& cloud, const Eigen::Vector3d& p_W, double radius) {
  const double reach = radius + cloud.radius;
  double least = std::numeric_limits<double>::infinity();
  auto point = std::lower_bound(cloud.points.begin(), cloud.points.end(), p_W.x() - reach,
                                [](const auto& p, double x) { return p.x() < x; });
  for (; point != cloud.points.end() && point->x() <= p_W.x() + reach; ++point) {
    least = std::min(least, (*point - p_W).norm() - reach);
  }
  return least;
}

/// A problem's obstacles as they are looked at, again and again.
struct World {
  const PlanSet& set;
  const Obstacles& obstacles;
  std::vector<SortedCloud> clouds;
};

double obstacle_clearance(const World& world, const Eigen::Vector3d& p_W, double radius) {
  double least = std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : world.obstacles.solids) {
    least = std::min(least, distance(obstacle, p_W) - radius);
  }
  for (const SortedCloud& cloud : world.clouds) {
    least = std::min(least, distance_to(cloud, p_W, radius));
  }
  return least;
}

Clearance clearance_at(const World& world, const JointVec& q) {
  const Centres centres = centres_at(world.set, q);
  Clearance least;
  const std::vector<LinkSpheres>& links = world.set.spheres.links;
  for (std::size_t l = 0; l < links.size(); ++l) {
    for (std::size_t s = 0; s < links[l].spheres.size(); ++s) {
      least.obstacle = std::min(
          least.obstacle, obstacle_clearance(world, centres[l][s], links[l].spheres[s].radius));
    }
  }
  for (const auto& [a, b] : world.set.spheres.pairs) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    for (std::size_t s = 0; s < centres[i].size(); ++s) {
      for (std::size_t t = 0; t < centres[j].size(); ++t) {
        const double radii = links[i].spheres[s].radius + links[j].spheres[t].radius;
        least.self = std::min(least.self, (centres[i][s] - centres[j][t]).norm() - radii);
      }
    }
  }
  return least;
}

bool is_near(std::span<const double> a, std::span<const double> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return std::abs(x - y) <= kEndTol; });
}

bool is_path(const Arm& arm, std::span<const std::vector<double>> path) {
  return !path.empty() && std::all_of(path.begin(), path.end(), [&](const std::vector<double>& q) {
    return q.size() == arm.joints.size() &&
           std::all_of(q.begin(), q.end(), [](double v) { return std::isfinite(v); });
  });
}

bool ends_at_goal(const PlanProblem& problem, std::span<const double> q) {
  return std::ranges::any_of(problem.goals,
                             [&](const JointVec& goal) { return is_near(q, as_span(goal)); });
}

PathFault fault_of_corners(const PlanSet& set, const PlanProblem& problem,
                           std::span<const std::vector<double>> path) {
  if (!is_near(path.front(), problem.start)) return PathFault::start;
  if (!ends_at_goal(problem, path.back())) return PathFault::goal;
  for (const std::vector<double>& corner : path) {
    const JointVec q = joint_vec(corner);
    if (((q - set.arm.limits.lower).array() < -kEndTol).any() ||
        ((q - set.arm.limits.upper).array() > kEndTol).any()) {
      return PathFault::limits;
    }
  }
  return PathFault::none;
}

}  // namespace

const char* name_of(PathFault fault) {
  constexpr const char* kNames[] = {"", "shape", "start", "goal", "limits", "obstacle", "self"};
  return kNames[static_cast<std::size_t>(fault)];
}

PathVerdict judge_path(const PlanSet& set, const PlanProblem& problem,
                       std::span<const std::vector<double>> path) {
  PathVerdict verdict;
  if (!is_path(set.arm, path)) return {.fault = PathFault::shape};
  verdict.fault = fault_of_corners(set, problem, path);
  const World world{set, problem.obstacles, sorted_clouds(problem.obstacles)};
  Clearance least = clearance_at(world, joint_vec(path.front()));
  for (std::size_t i = 1; i < path.size(); ++i) {
    const JointVec from = joint_vec(path[i - 1]), way = joint_vec(path[i]) - from;
    verdict.cost += way.norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / kSpacing)));
    for (int k = 1; k <= steps; ++k) {
      const JointVec q = from + way * (static_cast<double>(k) / steps);
      const Clearance here = clearance_at(world, q);
      least.obstacle = std::min(least.obstacle, here.obstacle);
      least.self = std::min(least.self, here.self);
    }
  }
  verdict.depth = std::max(0.0, -std::min(least.obstacle, least.self));
  if (verdict.fault == PathFault::none && verdict.depth > 0) {
    verdict.fault = least.obstacle <= least.self ? PathFault::obstacle : PathFault::self;
  }
  return verdict;
}

void judge_answers(const PlanSet& set, std::span<SolvedProblem> answers) {
  for (SolvedProblem& answer : answers) {
    if (answer.path.empty()) continue;
    answer.verdict = judge_path(set, set.cases[answer.problem], answer.path);
  }
}

}  // namespace mjarm::app
