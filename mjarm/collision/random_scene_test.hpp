#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "mjarm/collision/obstacles.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

/// Random robots and worlds, and an oracle of their clearance: textbook distances in double
/// precision, one sphere and one solid at a time.
namespace mjarm::testing {

inline Eigen::Vector3d random_vector(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// A few spheres on every link of an arm, and one piece at rest.
inline SphereSet random_spheres(const Arm& arm, Rng& rng) {
  SphereSet set;
  for (int joint = -1; joint < arm.dof(); ++joint) {
    LinkSpheres link{"link" + std::to_string(joint + 1), joint, {}};
    const int count = 1 + static_cast<int>(rng.below(5));
    for (int k = 0; k < count; ++k) {
      link.spheres.push_back({random_vector(rng, 0.15), rng.uniform(0.01, 0.08)});
    }
    set.links.push_back(link);
  }
  for (int a = 0; a < static_cast<int>(set.links.size()); ++a) {
    for (int b = a + 2; b < static_cast<int>(set.links.size()); ++b) {
      if (rng.uniform() < 0.3)
        set.pairs.push_back(rng.uniform() < 0.5 ? std::array{a, b} : std::array{b, a});
    }
  }
  return set;
}

/// A solid of any kind, `thin`: plates and wires. Half of them share one of two orientations.
inline Obstacle random_obstacle(Rng& rng, bool thin) {
  Obstacle out;
  out.X_WO.p = random_vector(rng, 1.2);
  const double turn = rng.uniform();
  if (turn < 0.5) out.X_WO.R = from_euler(random_vector(rng, 3));
  if (turn > 0.8) out.X_WO.R = from_euler({0, 0, turn > 0.9 ? 0.4 : std::numbers::pi / 2});
  const double size = thin ? 5e-4 : rng.uniform(0.02, 0.3);
  switch (rng.below(thin ? 2 : 5)) {
    case 0: {
      Eigen::Vector3d half(rng.uniform(0.05, 0.5), rng.uniform(0.05, 0.5), rng.uniform(0.05, 0.5));
      half[static_cast<Eigen::Index>(rng.below(3))] = size;
      out.shape = BoxShape{half};
      break;
    }
    case 1:
      out.shape = CapsuleShape{size, rng.uniform(0.05, 0.6)};
      break;
    case 2:
      out.shape = BallShape{size};
      break;
    case 3:
      out.shape = CylinderShape{size, rng.uniform(0.02, 0.4)};
      break;
    default:
      out.X_WO.p += 1.5 * out.X_WO.p.normalized();
      out.X_WO.R = rotation_between(Eigen::Vector3d::UnitZ(), -out.X_WO.p);
      out.shape = HalfSpaceShape{};
  }
  return out;
}

inline Obstacles random_world(Rng& rng, int count, bool thin = false) {
  Obstacles out;
  for (int i = 0; i < count; ++i) out.solids.push_back(random_obstacle(rng, thin));
  return out;
}

/// Points on a plane, on a line, in a heap or all in one place.
inline PointCloud random_cloud(Rng& rng, int count, double radius) {
  PointCloud out{"cloud", {}, radius};
  const Eigen::Vector3d middle = random_vector(rng, 0.9);
  const Eigen::Matrix3d R = from_euler(random_vector(rng, 3));
  Eigen::Vector3d half(rng.uniform(0.1, 0.6), rng.uniform(0.1, 0.6), rng.uniform(0.1, 0.6));
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(rng.below(4)); ++k) half[k] = 0;
  for (int i = 0; i < count; ++i) {
    out.points_W.push_back(middle + R * half.cwiseProduct(random_vector(rng, 1)));
  }
  return out;
}

/// A ball of triangles, pushed about but closed; `size` [m] at most its radius.
inline MeshShape random_closed_mesh(Rng& rng, double size) {
  MeshShape out{{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {}, true};
  for (int k = 0; k < 4; ++k) {
    const int a = 2 + k, b = 2 + (k + 1) % 4;
    out.faces.push_back({0, a, b});
    out.faces.push_back({1, b, a});
  }
  for (int round = static_cast<int>(rng.below(3)); round > 0; --round) {
    std::map<std::array<int, 2>, int> middle;
    const auto between = [&](int a, int b) {
      const std::array key{std::min(a, b), std::max(a, b)};
      const auto [at, is_new] = middle.try_emplace(key, static_cast<int>(out.vertices.size()));
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      if (is_new) out.vertices.push_back((out.vertices[i] + out.vertices[j]).normalized());
      return at->second;
    };
    std::vector<std::array<int, 3>> faces;
    for (const auto& [a, b, c] : out.faces) {
      const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
      for (const auto& face : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
        faces.push_back(face);
      }
    }
    out.faces = faces;
  }
  const Eigen::Vector3d half(rng.uniform(0.2, 1), rng.uniform(0.2, 1), rng.uniform(0.2, 1));
  for (Eigen::Vector3d& vertex : out.vertices) {
    vertex = size * rng.uniform(0.4, 1) * half.cwiseProduct(vertex);
  }
  return out;
}

/// Triangles of all shapes, some of which are lines or points.
inline MeshShape random_triangles(Rng& rng, int count, double size) {
  MeshShape out;
  for (int f = 0; f < count; ++f) {
    const Eigen::Vector3d a = random_vector(rng, size), way = random_vector(rng, size);
    const double thin = rng.uniform() < 0.5 ? 1 : std::pow(10, rng.uniform(-8, 0));
    const double last = rng.uniform() < 0.1 ? 0 : 1;
    out.vertices.insert(out.vertices.end(),
                        {a, a + last * way,
                         a + last * rng.uniform() * way + last * thin * random_vector(rng, size)});
    out.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return out;
}

inline HeightFieldShape random_field(Rng& rng) {
  HeightFieldShape out;
  out.rows = 2 + static_cast<int>(rng.below(12));
  out.cols = 2 + static_cast<int>(rng.below(12));
  out.half = {rng.uniform(0.1, 1), rng.uniform(0.1, 1)};
  out.bottom = rng.uniform(-0.2, 0);
  for (int i = 0; i < out.rows * out.cols; ++i) out.heights.push_back(rng.uniform(0.001, 0.2));
  return out;
}

/// A solid of many pieces.
inline Obstacle random_composite(Rng& rng) {
  Obstacle out;
  out.X_WO.p = random_vector(rng, 0.9);
  if (rng.uniform() < 0.7) out.X_WO.R = from_euler(random_vector(rng, 3));
  const double size = rng.uniform(0.05, 0.3);
  switch (rng.below(4)) {
    case 0:
      out.shape = random_closed_mesh(rng, size);
      break;
    case 1:
      out.shape = random_triangles(rng, 1 + static_cast<int>(rng.below(20)), size);
      break;
    case 2:
      out.shape = random_field(rng);
      break;
    default: {
      std::vector<Eigen::Vector3d> points;
      const int count = 4 + static_cast<int>(rng.below(30));
      for (int i = 0; i < count; ++i) points.push_back(random_vector(rng, size));
      out.shape = make_polytope(points).value();
    }
  }
  return out;
}

/// By the region of the triangle in which the point is (C. Ericson, 2005, 5.1.5).
inline double triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, bc = c - b;
  const auto line = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
    return (from + std::clamp(way.dot(p - from) / way.squaredNorm(), 0.0, 1.0) * way - p).norm();
  };
  const auto segment = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
    return way.norm() > 0 ? line(from, way) : (from - p).norm();
  };
  const double edges = std::min({segment(a, ab), segment(a, ac), segment(b, bc)});
  Eigen::Matrix<double, 3, 2> M;
  M << ab, ac;
  const Eigen::Matrix2d G = M.transpose() * M;
  if (G.determinant() <= 1e-14 * G(0, 0) * G(1, 1)) return edges;
  const Eigen::Vector2d at = G.inverse() * (M.transpose() * (p - a));
  if (at.minCoeff() < 0 || at.sum() > 1) return edges;
  return std::min(edges, (a + M * at - p).norm());
}

/// From a point to the nearest triangle; 0 inside of a solid, by its winding number (A. Van
/// Oosterom and J. Strackee, 1983).
inline double mesh_distance(const MeshShape& mesh, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity(), angle = 0;
  for (const auto& face : mesh.faces) {
    std::array<Eigen::Vector3d, 3> v;
    for (std::size_t k = 0; k < 3; ++k) v[k] = mesh.vertices[static_cast<std::size_t>(face[k])];
    least = std::min(least, triangle_distance(p, v[0], v[1], v[2]));
    for (Eigen::Vector3d& corner : v) corner -= p;
    const double a = v[0].norm(), b = v[1].norm(), c = v[2].norm();
    angle +=
        2 * std::atan2(v[0].dot(v[1].cross(v[2])),
                       a * b * c + v[0].dot(v[1]) * c + v[1].dot(v[2]) * a + v[2].dot(v[0]) * b);
  }
  return mesh.solid && std::abs(angle) > 2 * std::numbers::pi ? 0 : least;
}

inline double field_distance(const HeightFieldShape& field, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (int r = 0; r < field.rows - 1; ++r) {
    for (int c = 0; c < field.cols - 1; ++c) {
      double top = field.bottom;
      for (const int i : {r, r + 1}) {
        for (const int j : {c, c + 1}) {
          top = std::max(top, field.heights[static_cast<std::size_t>(i * field.cols + j)]);
        }
      }
      const auto place = [](int k, int count, double half) {
        return half * (2.0 * k / (count - 1) - 1);
      };
      const double x = std::clamp(p.x(), place(c, field.cols, field.half.x()),
                                  place(c + 1, field.cols, field.half.x()));
      const double y = std::clamp(p.y(), place(r, field.rows, field.half.y()),
                                  place(r + 1, field.rows, field.half.y()));
      const Eigen::Vector3d nearest(x, y, std::clamp(p.z(), field.bottom, top));
      least = std::min(least, (p - nearest).norm());
    }
  }
  return least;
}

/// From a point to the nearest point of a solid; the point is in its frame.
inline double point_distance(const ObstacleShape& shape, const Eigen::Vector3d& p) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mesh_distance(*mesh, p);
  if (const auto* field = std::get_if<HeightFieldShape>(&shape)) return field_distance(*field, p);
  if (const auto* polytope = std::get_if<PolytopeShape>(&shape)) {
    double gap = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector4d& plane : polytope->planes) {
      gap = std::max(gap, plane.head<3>().dot(p) - plane.w());
    }
    return std::max({gap, (polytope->low - p).maxCoeff(), (p - polytope->high).maxCoeff(), 0.0});
  }
  if (const auto* ball = std::get_if<BallShape>(&shape)) return p.norm() - ball->radius;
  if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) {
    const double z = std::clamp(p.z(), -capsule->half_length, capsule->half_length);
    return (p - Eigen::Vector3d(0, 0, z)).norm() - capsule->radius;
  }
  if (const auto* box = std::get_if<BoxShape>(&shape)) {
    return (p - p.cwiseMax(-box->half).cwiseMin(box->half)).norm();
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    const double radial = p.head<2>().norm();
    Eigen::Vector3d nearest = p;
    if (radial > cylinder->radius) nearest.head<2>() *= cylinder->radius / radial;
    nearest.z() = std::clamp(p.z(), -cylinder->half_length, cylinder->half_length);
    return (p - nearest).norm();
  }
  return p.z();
}

/// The same, exact beyond the edges of polytopes as well: the point is put onto one plane after the
/// other (J. P. Boyle and R. L. Dykstra, 1986), which tends to its projection.
inline double exact_point_distance(const ObstacleShape& shape, const Eigen::Vector3d& p) {
  const auto* polytope = std::get_if<PolytopeShape>(&shape);
  if (polytope == nullptr) return point_distance(shape, p);
  std::vector<Eigen::Vector4d> planes = polytope->planes;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    planes.push_back((Eigen::Vector4d() << axis, polytope->high[k]).finished());
    planes.push_back((Eigen::Vector4d() << -axis, -polytope->low[k]).finished());
  }
  std::vector<double> pushed(planes.size(), 0.0);
  Eigen::Vector3d x = p;
  for (int round = 0; round < 2000; ++round) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const Eigen::Vector3d n = planes[i].head<3>();
      x += pushed[i] * n;
      pushed[i] = std::max(n.dot(x) - planes[i].w(), 0.0);
      x -= pushed[i] * n;
    }
  }
  return (x - p).norm();
}

/// SphereClearance of a configuration; negative where something overlaps. `moving_only`: links at
/// rest are held against other links alone.
inline double true_clearance(const Arm& arm, const SphereSet& set, const Obstacles& world,
                             std::span<const double> q, bool moving_only = false,
                             double (*distance_to)(const ObstacleShape&,
                                                   const Eigen::Vector3d&) = point_distance) {
  std::vector<Pose> X_WJ(static_cast<std::size_t>(arm.dof()));
  fk_all(arm, q, X_WJ);
  std::vector<std::vector<Eigen::Vector3d>> centers;
  double least = std::numeric_limits<double>::infinity();
  for (const LinkSpheres& link : set.links) {
    const Pose X = link.joint < 0 ? Pose() : X_WJ[static_cast<std::size_t>(link.joint)];
    centers.emplace_back();
    for (const Sphere& sphere : link.spheres) {
      const Eigen::Vector3d center = X * sphere.center;
      centers.back().push_back(center);
      if (moving_only && link.joint < 0) continue;
      for (const Obstacle& solid : world.solids) {
        const Eigen::Vector3d p = solid.X_WO.inverse() * center;
        least = std::min(least, distance_to(solid.shape, p) - sphere.radius);
      }
      for (const PointCloud& cloud : world.clouds) {
        for (const Eigen::Vector3d& point : cloud.points_W) {
          least = std::min(least, (point - center).norm() - cloud.radius - sphere.radius);
        }
      }
    }
  }
  for (const auto& [a, b] : set.pairs) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    for (std::size_t k = 0; k < centers[i].size(); ++k) {
      for (std::size_t l = 0; l < centers[j].size(); ++l) {
        const double radii = set.links[i].spheres[k].radius + set.links[j].spheres[l].radius;
        least = std::min(least, (centers[i][k] - centers[j][l]).norm() - radii);
      }
    }
  }
  return least;
}

}  // namespace mjarm::testing
