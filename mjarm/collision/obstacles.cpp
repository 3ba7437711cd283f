#include "mjarm/collision/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/collision/mesh_internal.hpp"
#include "mjarm/core/messages/collision.hpp"

namespace mjarm {
namespace {

constexpr double kLeastSize = 1e-9;  // [m]
constexpr double kMaxSize = 1e4;     // [m]

/// Distance of `p`, in the frame of the solid.
struct DistanceTo {
  Eigen::Vector3d p;

  double operator()(const BallShape& ball) const { return std::max(p.norm() - ball.radius, 0.0); }
  double operator()(const CapsuleShape& capsule) const {
    const double beyond = std::max(std::abs(p.z()) - capsule.half_length, 0.0);
    return std::max(std::hypot(p.x(), p.y(), beyond) - capsule.radius, 0.0);
  }
  double operator()(const BoxShape& box) const {
    return (p.cwiseAbs() - box.half).cwiseMax(0.0).norm();
  }
  double operator()(const CylinderShape& cylinder) const {
    const double side = std::max(std::hypot(p.x(), p.y()) - cylinder.radius, 0.0);
    const double beyond = std::max(std::abs(p.z()) - cylinder.half_length, 0.0);
    return std::hypot(side, beyond);
  }
  double operator()(const HalfSpaceShape&) const { return std::max(p.z(), 0.0); }
  double operator()(const PolytopeShape& polytope) const {
    double gap = (p - p.cwiseMax(polytope.low).cwiseMin(polytope.high)).cwiseAbs().maxCoeff();
    for (const Eigen::Vector4d& plane : polytope.planes) {
      gap = std::max(gap, plane.head<3>().dot(p) - plane.w());
    }
    return gap;
  }
  double operator()(const MeshShape& mesh) const {
    const auto corner = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : mesh.faces) {
      least = std::min(least, detail::distance_to_triangle(p, corner(a), corner(b), corner(c)));
    }
    if (!mesh.solid) return least;
    return detail::InsideTest(mesh.vertices, mesh.faces).is_inside(p) ? 0 : least;
  }
  double operator()(const HeightFieldShape& field) const {
    double least = std::numeric_limits<double>::infinity();
    detail::for_each_column(field, [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
      least = std::min(least, (p - p.cwiseMax(low).cwiseMin(high)).norm());
    });
    return least;
  }
};

bool size_fits(double size) { return size >= kLeastSize && size <= kMaxSize; }

bool place_fits(const Eigen::Vector3d& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxSize;
}

struct SizesFit {
  bool operator()(const BallShape& ball) const { return size_fits(ball.radius); }
  bool operator()(const CapsuleShape& capsule) const {
    return size_fits(capsule.radius) && capsule.half_length >= 0 && capsule.half_length <= kMaxSize;
  }
  bool operator()(const BoxShape& box) const {
    return size_fits(box.half.x()) && size_fits(box.half.y()) && size_fits(box.half.z());
  }
  bool operator()(const CylinderShape& cylinder) const {
    return size_fits(cylinder.radius) && size_fits(cylinder.half_length);
  }
  bool operator()(const HeightFieldShape& field) const {
    return size_fits(field.half.x()) && size_fits(field.half.y());
  }
  template <class Shape>
  bool operator()(const Shape&) const {
    return true;
  }
};

/// Looks at what a shape is made of. Obstacle `i` is its owner.
struct PartsFit {
  std::size_t i;
  const std::string& name;

  Result<void> operator()(const PolytopeShape& polytope) const {
    const auto fits = [](const Eigen::Vector4d& plane) {
      return plane.allFinite() && std::abs(plane.head<3>().norm() - 1) < 1e-6 &&
             std::abs(plane.w()) <= 2 * kMaxSize;
    };
    const auto& planes = polytope.planes;
    if (!place_fits(polytope.low) || !place_fits(polytope.high) ||
        (polytope.low.array() > polytope.high.array()).any() || planes.empty() ||
        planes.size() > kMaxPlanes || !std::all_of(planes.begin(), planes.end(), fits)) {
      return fail(Errc::bad_input, text(msg::collision_polytope, i, name, kMaxPlanes));
    }
    return {};
  }
  Result<void> operator()(const MeshShape& mesh) const {
    const auto& vertices = mesh.vertices;
    const auto bad = std::find_if_not(vertices.begin(), vertices.end(), place_fits);
    if (bad != vertices.end()) {
      return fail(Errc::bad_input,
                  text(msg::collision_mesh_vertex, i, name, bad - vertices.begin()));
    }
    const auto is_vertex = [&](int v) { return v >= 0 && v < std::ssize(vertices); };
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto& face = mesh.faces[f];
      if (!std::all_of(face.begin(), face.end(), is_vertex)) {
        return fail(Errc::bad_input, text(msg::collision_mesh_face, i, name, f, vertices.size()));
      }
    }
    if (mesh.faces.empty()) return fail(Errc::bad_input, text(msg::collision_mesh_empty, i, name));
    if (mesh.solid && !is_closed(mesh)) {
      return fail(Errc::bad_input, text(msg::collision_mesh_open, i, name));
    }
    return {};
  }
  Result<void> operator()(const HeightFieldShape& field) const {
    const auto fits = [&](double height) {
      return std::isfinite(height) && std::abs(height) <= kMaxSize && height > field.bottom;
    };
    const auto& heights = field.heights;
    const auto bad = std::find_if_not(heights.begin(), heights.end(), fits);
    if (field.rows < 2 || field.cols < 2 || !(std::abs(field.bottom) <= kMaxSize) ||
        heights.size() / static_cast<std::size_t>(field.cols) !=
            static_cast<std::size_t>(field.rows) ||
        heights.size() % static_cast<std::size_t>(field.cols) != 0) {
      return fail(Errc::bad_input,
                  text(msg::collision_field_size, i, name, field.rows, field.cols, heights.size()));
    }
    if (bad != heights.end()) {
      return fail(Errc::bad_input,
                  text(msg::collision_field_height, i, name, bad - heights.begin()));
    }
    return {};
  }
  template <class Shape>
  Result<void> operator()(const Shape&) const {
    return {};
  }
};

struct CountPieces {
  std::size_t operator()(const PolytopeShape& polytope) const { return polytope.planes.size(); }
  std::size_t operator()(const MeshShape& mesh) const { return mesh.faces.size(); }
  std::size_t operator()(const HeightFieldShape& field) const { return field.heights.size(); }
  template <class Shape>
  std::size_t operator()(const Shape&) const {
    return 1;
  }
};

bool is_rotation(const Eigen::Matrix3d& R) {
  return R.allFinite() && (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
         R.determinant() > 0;
}

Result<void> check_clouds(const std::vector<PointCloud>& clouds) {
  std::size_t points = 0;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const PointCloud& cloud = clouds[i];
    points += cloud.points_W.size();
    if (points > kMaxPoints) {
      return fail(Errc::bad_input, text(msg::collision_many_points, i, cloud.name, kMaxPoints));
    }
    if (!size_fits(cloud.radius)) {
      return fail(Errc::bad_input, text(msg::collision_cloud_radius, i, cloud.name));
    }
    const auto bad = std::find_if_not(cloud.points_W.begin(), cloud.points_W.end(), place_fits);
    if (bad != cloud.points_W.end()) {
      return fail(Errc::bad_input,
                  text(msg::collision_cloud_point, i, cloud.name, bad - cloud.points_W.begin()));
    }
  }
  return {};
}

}  // namespace

double distance(const Obstacle& obstacle, const Eigen::Vector3d& p_W) noexcept {
  const Eigen::Vector3d p_O = obstacle.X_WO.R.transpose() * (p_W - obstacle.X_WO.p);
  return std::visit(DistanceTo{p_O}, obstacle.shape);
}

double distance(const PointCloud& cloud, const Eigen::Vector3d& p_W) noexcept {
  double least2 = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : cloud.points_W) {
    least2 = std::min(least2, (point - p_W).squaredNorm());
  }
  return std::max(std::sqrt(least2) - cloud.radius, 0.0);
}

const std::string& obstacle_name(const Obstacles& obstacles, int index) noexcept {
  const auto i = static_cast<std::size_t>(index);
  const std::size_t solids = obstacles.solids.size();
  return i < solids ? obstacles.solids[i].name : obstacles.clouds[i - solids].name;
}

Result<void> check_obstacles(const Obstacles& obstacles, int links) {
  const std::vector<Obstacle>& solids = obstacles.solids;
  const std::size_t count = solids.size() + obstacles.clouds.size();
  if (count > kMaxObstacles) {
    return fail(Errc::bad_input, text(msg::collision_many_obstacles, count, kMaxObstacles));
  }
  std::size_t pieces = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Obstacle& obstacle = solids[i];
    const Pose& X = obstacle.X_WO;
    if (!place_fits(X.p)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_place, i, obstacle.name));
    }
    if (!is_rotation(X.R)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_turn, i, obstacle.name));
    }
    if (!std::visit(SizesFit{}, obstacle.shape)) {
      return fail(Errc::bad_input, text(msg::collision_obstacle_size, i, obstacle.name));
    }
    pieces += std::visit(CountPieces{}, obstacle.shape);
    if (pieces > kMaxPieces) {
      return fail(Errc::bad_input, text(msg::collision_many_pieces, i, obstacle.name, kMaxPieces));
    }
    const Result<void> fine = std::visit(PartsFit{i, obstacle.name}, obstacle.shape);
    if (!fine) return fine;
  }
  for (std::size_t i = 0; i < obstacles.ignored.size(); ++i) {
    const auto& [link, obstacle] = obstacles.ignored[i];
    if (link < 0 || link >= links || obstacle < 0 || obstacle >= std::ssize(solids)) {
      return fail(Errc::bad_input, text(msg::collision_ignored, i, link, obstacle));
    }
  }
  return check_clouds(obstacles.clouds);
}

}  // namespace mjarm
