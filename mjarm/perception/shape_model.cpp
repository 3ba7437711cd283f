#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/perception/shape_model_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr int kPoints = 300;

/// A point of a triangle for each pair of numbers in [0, 1).
Eigen::Vector3d point_of(const std::array<Eigen::Vector3d, 3>& corners, double s, double t) {
  if (s + t > 1) {
    s = 1 - s;
    t = 1 - t;
  }
  return corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
}

/// Joins the vertices of each cell of a grid (J. Rossignac and P. Borrel, 1993).
Surface joined(const Surface& surface, double cell) {
  std::map<std::array<long, 3>, int> cells;
  std::vector<int> number;
  std::vector<int> count;
  Surface out;
  for (const Eigen::Vector3d& v : surface.vertices) {
    const auto at = [cell](double x) { return std::lround(x / cell); };
    const auto [found, is_new] =
        cells.try_emplace({at(v.x()), at(v.y()), at(v.z())}, static_cast<int>(count.size()));
    if (is_new) {
      out.vertices.emplace_back(Eigen::Vector3d::Zero());
      count.push_back(0);
    }
    const auto i = static_cast<std::size_t>(found->second);
    out.vertices[i] += v;
    ++count[i];
    number.push_back(found->second);
  }
  for (std::size_t i = 0; i < count.size(); ++i) out.vertices[i] /= count[i];
  std::set<std::array<int, 3>> known;
  for (const auto& triangle : surface.triangles) {
    std::array<int, 3> t;
    for (std::size_t i = 0; i < 3; ++i) t[i] = number[static_cast<std::size_t>(triangle[i])];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::array<int, 3> sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (known.insert(sorted).second) out.triangles.push_back(t);
  }
  return out;
}

/// True where each edge has a triangle on both sides, all of them go round the same way, and the
/// solid is on the inner side.
bool is_closed(const Surface& surface) {
  std::map<std::pair<int, int>, int> edges;
  double volume = 0;
  for (const auto& t : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const auto at = [&](std::size_t i) { return surface.vertices[static_cast<std::size_t>(t[i])]; };
    volume += at(0).dot(at(1).cross(at(2)));
  }
  return volume > 0 && std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
           const auto other = edges.find({edge.first.second, edge.first.first});
           return edge.second == 1 && other != edges.end() && other->second == 1;
         });
}

/// [m] The distance of the nearest face's plane where all faces look away from `centre`, else 0.
double inner_radius(const DrawnSurface& drawn, const Eigen::Vector3d& centre) {
  if (drawn.sides != Raster::Sides::front) return 0;
  double least = 1e9;
  for (const auto& t : drawn.surface.triangles) {
    const auto at = [&](std::size_t i) {
      return drawn.surface.vertices[static_cast<std::size_t>(t[i])];
    };
    const Eigen::Vector3d n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    least = std::min(least, n.dot(at(0) - centre));
  }
  return std::max(0.0, least);
}

}  // namespace

DrawnSurface::DrawnSurface(Surface of)
    : surface(std::move(of)),
      sides(is_closed(surface) ? Raster::Sides::front : Raster::Sides::both) {}

ShapeModel::ShapeModel(Surface of) : fine(std::move(of)), coarse(Surface{}) {
  const Surface& surface = fine.surface;
  const auto corners = [&](const std::array<int, 3>& triangle) {
    std::array<Eigen::Vector3d, 3> out;
    for (std::size_t i = 0; i < 3; ++i) {
      out[i] = surface.vertices[static_cast<std::size_t>(triangle[i])];
    }
    return out;
  };
  double area = 0;
  for (const auto& triangle : surface.triangles) {
    const auto c = corners(triangle);
    const double part = (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2;
    area += part;
    centre += part * (c[0] + c[1] + c[2]) / 3;
  }
  if (area > 0) centre /= area;
  for (const Eigen::Vector3d& v : surface.vertices) radius = std::max(radius, (v - centre).norm());
  inner = inner_radius(fine, centre);
  coarse = DrawnSurface(joined(surface, 0.15 * radius));
  // Each point stands for as much of the surface; within a triangle they follow an even sequence
  // (M. Roberts' R2).
  double passed = 0;
  for (const auto& triangle : surface.triangles) {
    const auto c = corners(triangle);
    const Eigen::Vector3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    passed += n.norm() / 2;
    while (static_cast<double>(points.size()) + 0.5 < kPoints * passed / area) {
      const auto i = static_cast<double>(points.size() + 1);
      const double s = 0.7548776662466927 * i;
      const double t = 0.5698402909980532 * i;
      points.push_back(point_of(c, s - std::floor(s), t - std::floor(t)));
      normals.push_back(n.normalized());
    }
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) spread += (p - centre) * (p - centre).transpose();
  axes = symmetric_eigen(spread).vectors;
}

double surface_distance(const ShapeModel& shape, const Pose& A, const Pose& B) {
  const Pose X_BA = B.inverse() * A;
  double sum = 0;
  for (const Eigen::Vector3d& point : shape.points) {
    const Eigen::Vector3d p = X_BA * point;
    double least = 1e9;
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < shape.points.size(); ++i) {
      const double d = (shape.points[i] - p).squaredNorm();
      if (d >= least) continue;
      least = d;
      nearest = i;
    }
    const double off = shape.normals[nearest].dot(p - shape.points[nearest]);
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, shape.points.size())));
}

Eigen::Matrix<double, 6, 6> normal_motion(const ShapeModel& shape, const Pose& X) {
  Eigen::Matrix<double, 6, 6> M = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t i = 0; i < shape.points.size(); ++i) {
    const Eigen::Vector3d n = X.R * shape.normals[i];
    const Eigen::Vector3d arm = X.R * (shape.points[i] - shape.centre);
    Eigen::Matrix<double, 6, 1> row;
    row << n, arm.cross(n);
    M += row * row.transpose() / static_cast<double>(shape.points.size());
  }
  return M;
}

}  // namespace mjarm::perception
