#include "mjarm/collision/link_balls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mjarm/collision/mesh_internal.hpp"
#include "mjarm/collision/solid_scene_internal.hpp"
#include "mjarm/core/finite.hpp"

namespace mjarm {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kBallsOfLink = 2;

/// Adds the largest ball of a link, and the largest of those whose centre is outside of it.
void add_largest(std::vector<LinkBall> of_link, std::vector<LinkBall>& out) {
  std::ranges::stable_sort(of_link, std::greater<>(), &LinkBall::radius);
  const auto first = std::ssize(out);
  for (LinkBall& ball : of_link) {
    if (out.size() == static_cast<std::size_t>(first) + kBallsOfLink) return;
    const auto holds = [&](const LinkBall& taken) {
      return (taken.center - ball.center).norm() < taken.radius;
    };
    if (std::none_of(out.begin() + first, out.end(), holds)) out.push_back(ball);
  }
}

/// Those of `all` (grouped by link), links of the tip first.
std::vector<LinkBall> choose(std::span<const LinkBall> all) {
  std::vector<std::vector<LinkBall>> links;
  for (const LinkBall& ball : all) {
    if (links.empty() || links.back().front().link != ball.link) links.emplace_back();
    links.back().push_back(ball);
  }
  std::ranges::stable_sort(links, std::greater<>(),
                           [](const auto& link) { return link.front().joint; });
  std::vector<LinkBall> out;
  for (std::vector<LinkBall>& link : links) add_largest(std::move(link), out);
  return out;
}

Vector3d corner(const MeshShape& mesh, int index) {
  return mesh.vertices[static_cast<std::size_t>(index)];
}

/// Adds the pieces of an obstacle.
class PieceMaker {
 public:
  PieceMaker(const Obstacle& obstacle, int index, std::vector<StandingPiece>& out)
      : obstacle_(obstacle), index_(index), out_(out) {}

  void operator()(const BallShape& ball) const { whole(Vector3d::Constant(ball.radius)); }
  void operator()(const CapsuleShape& capsule) const {
    whole({capsule.radius, capsule.radius, capsule.half_length + capsule.radius});
  }
  void operator()(const BoxShape& box) const { whole(box.half); }
  void operator()(const CylinderShape& cylinder) const {
    whole({cylinder.radius, cylinder.radius, cylinder.half_length});
  }
  void operator()(const HalfSpaceShape&) const {
    const Vector3d all = Vector3d::Constant(kInfinity);
    add({-all, all, index_,
         [this_ = &obstacle_](const Vector3d& p, double) { return distance(*this_, p); }});
  }
  /// distance() of a polytope is too small beyond its edges; where the way to the farthest plane
  /// ends on the solid it is right.
  void operator()(const PolytopeShape& polytope) const {
    const auto box = detail::bounds_in_world(obstacle_.X_WO, {polytope.low, polytope.high});
    const auto to = [this_ = &obstacle_](const Vector3d& p_W, double) {
      const auto& solid = std::get<PolytopeShape>(this_->shape);
      const Vector3d p = this_->X_WO.R.transpose() * (p_W - this_->X_WO.p);
      const Vector3d in_box = p.cwiseMax(solid.low).cwiseMin(solid.high);
      Vector3d nearest = in_box;
      double farthest = (p - in_box).norm();
      for (const Eigen::Vector4d& plane : solid.planes) {
        const double beyond = plane.head<3>().dot(p) - plane.w();
        if (beyond <= farthest) continue;
        farthest = beyond;
        nearest = p - beyond * plane.head<3>();
      }
      constexpr double kRounding = 1e-9;  // [m]
      return distance(*this_, this_->X_WO * nearest) <= kRounding ? farthest : kInfinity;
    };
    add({box.low, box.high, index_, to});
  }
  /// Triangles alone: what is inside of a solid cannot be reached without passing them.
  void operator()(const MeshShape& mesh) const {
    for (const std::array<int, 3>& face : mesh.faces) {
      Vector3d low = Vector3d::Constant(kInfinity), high = -low;
      for (const int i : face) {
        const Vector3d p = obstacle_.X_WO * corner(mesh, i);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      add({low, high, index_, [this_ = &obstacle_, at = &face](const Vector3d& p_W, double) {
             const auto& solid = std::get<MeshShape>(this_->shape);
             const Vector3d p = this_->X_WO.R.transpose() * (p_W - this_->X_WO.p);
             return detail::distance_to_triangle(p, corner(solid, (*at)[0]),
                                                 corner(solid, (*at)[1]), corner(solid, (*at)[2]));
           }});
    }
  }
  void operator()(const HeightFieldShape& field) const {
    detail::for_each_column(field, [&](const Vector3d& low, const Vector3d& high) {
      const auto box = detail::bounds_in_world(obstacle_.X_WO, {low, high});
      add({box.low, box.high, index_, [this_ = &obstacle_, low, high](const Vector3d& p_W, double) {
             const Vector3d p = this_->X_WO.R.transpose() * (p_W - this_->X_WO.p);
             return (p - p.cwiseMax(low).cwiseMin(high)).norm();
           }});
    });
  }

 private:
  void whole(const Vector3d& half) const {
    const auto box = detail::bounds_in_world(obstacle_.X_WO, {-half, half});
    add({box.low, box.high, index_,
         [this_ = &obstacle_](const Vector3d& p, double) { return distance(*this_, p); }});
  }
  void add(StandingPiece piece) const { out_.push_back(std::move(piece)); }

  const Obstacle& obstacle_;
  int index_;
  std::vector<StandingPiece>& out_;
};

BallScene scene_of_spheres(const SphereSet& set, const Obstacles& obstacles) {
  std::vector<LinkBall> all;
  for (std::size_t l = 0; l < set.links.size(); ++l) {
    const LinkSpheres& link = set.links[l];
    if (link.joint < 0) continue;
    for (const Sphere& sphere : link.spheres) {
      all.push_back({static_cast<int>(l), link.joint, sphere.center, sphere.radius});
    }
  }
  BallScene out{choose(all), {}, obstacles.ignored};
  int index = 0;
  for (const Obstacle& obstacle : obstacles.solids) {
    std::visit(PieceMaker(obstacle, index++, out.pieces), obstacle.shape);
  }
  for (const PointCloud& cloud : obstacles.clouds) {
    const Vector3d half = Vector3d::Constant(cloud.radius);
    for (const Vector3d& point : cloud.points_W) {
      out.pieces.push_back({point - half, point + half, index,
                            [at = &point, radius = cloud.radius](const Vector3d& p, double) {
                              return std::max((p - *at).norm() - radius, 0.0);
                            }});
    }
    ++index;
  }
  return out;
}

void add_ignored(const detail::StandingSolid& standing, int index, std::vector<IgnoredPair>& out) {
  for (std::size_t l = 0; l < standing.ignored.size(); ++l) {
    if (standing.ignored[l] != 0) out.push_back({static_cast<int>(l), index});
  }
}

BallScene scene_of_solids(const detail::SolidScene& scene) {
  std::vector<LinkBall> all;
  for (const detail::LinkSolid& solid : scene.solids()) {
    const Sphere ball = solid.convex.inscribed_ball();
    if (ball.radius > 0) all.push_back({solid.link, solid.joint, ball.center, ball.radius});
  }
  BallScene out{choose(all), {}, {}};
  int index = 0;
  for (const detail::StandingSolid& standing : scene.standing()) {
    add_ignored(standing, index, out.ignored);
    out.pieces.push_back(
        {standing.low, standing.high, index++, [at = &standing](const Vector3d& p, double enough) {
           return detail::distance_to_standing(p, *at, enough);
         }});
  }
  return out;
}

}  // namespace

BallScene ball_scene(const FastChecker& checker, const Obstacles& obstacles) {
  if (checker.solids()) return scene_of_solids(*checker.solids());
  return scene_of_spheres(checker.robot().spheres(), obstacles);
}

}  // namespace mjarm
