#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/collision/cover_solid_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kNoBound = std::numeric_limits<double>::infinity();

double from_box(const Vector3d& half, const Vector3d& p) {
  const Vector3d beyond = p.cwiseAbs() - half;
  return beyond.maxCoeff() <= 0 ? beyond.maxCoeff() : beyond.cwiseMax(0.0).norm();
}

double from_cylinder(double radius, double half, const Vector3d& p) {
  const double side = std::hypot(p.x(), p.y()) - radius;
  const double beyond = std::abs(p.z()) - half;
  if (side <= 0 || beyond <= 0) return std::max(side, beyond);
  return std::hypot(side, beyond);
}

/// The nearest point x of the surface has x = a^2 y / (t + a^2) for one t > -min(a)^2, which is
/// found by bisection (D. Eberly, Distance from a point to an ellipse, an ellipsoid, 2013).
double from_ellipsoid(const Vector3d& a, const Vector3d& p) {
  // No coordinate is quite 0, which keeps clear of the case without such a t.
  const Vector3d y = p.cwiseAbs().cwiseMax(1e-9 * a);
  const Vector3d a2 = a.cwiseProduct(a);
  const double least = a2.minCoeff();
  const auto nearest = [&](double s) -> Vector3d {
    return a2.cwiseProduct(y).cwiseQuotient((a2.array() - least + s).matrix());
  };
  double low = 0, high = least + a.cwiseProduct(y).norm();
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    const double s = 0.5 * (low + high);
    (nearest(s).cwiseQuotient(a).squaredNorm() > 1 ? low : high) = s;
  }
  const double distance = (nearest(0.5 * (low + high)) - y).norm();
  return y.cwiseQuotient(a).squaredNorm() > 1 ? distance : -distance;
}

/// The point of a segment that is nearest to p.
Vector3d nearest_on(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d way = b - a;
  const double length2 = way.squaredNorm();
  return length2 > 0 ? Vector3d(a + std::clamp(way.dot(p - a) / length2, 0.0, 1.0) * way) : a;
}

/// The same of a triangle.
Vector3d nearest_on(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Vector3d& from, const Vector3d& to) {
    return normal.cross(to - from).dot(p - from) >= 0;
  };
  if (is_inside(a, b) && is_inside(b, c) && is_inside(c, a) && normal.squaredNorm() > 0) {
    return p - normal.dot(p - a) / normal.squaredNorm() * normal;
  }
  Vector3d best = nearest_on(p, a, b);
  for (const Vector3d& x : {nearest_on(p, b, c), nearest_on(p, c, a)}) {
    if ((x - p).squaredNorm() < (best - p).squaredNorm()) best = x;
  }
  return best;
}

/// Half extents of a box round a box, ellipsoid or cylinder.
Vector3d half_extents(const CoverSolid& solid) {
  const Vector3d& size = solid.size;
  return solid.kind == SolidKind::cylinder ? Vector3d(size.x(), size.x(), size.y()) : size;
}

/// Points of the circle of that radius about z, at that height.
void add_circle(double radius, double z, int count, std::vector<Vector3d>& out) {
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    out.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
}

/// Points of the edges of a box, at most `spacing` apart.
void add_edges(const Vector3d& half, double spacing, std::vector<Vector3d>& out) {
  for (int along = 0; along < 3; ++along) {
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * half[along] / spacing)));
    for (int corner = 0; corner < 4; ++corner) {
      for (int k = 0; k <= steps; ++k) {
        Vector3d p;
        p[along] = half[along] * (2.0 * k / steps - 1);
        p[(along + 1) % 3] = half[(along + 1) % 3] * ((corner & 1) != 0 ? 1 : -1);
        p[(along + 2) % 3] = half[(along + 2) % 3] * ((corner & 2) != 0 ? 1 : -1);
        out.push_back(p);
      }
    }
  }
}

std::vector<Vector3d> into_link(const Pose& X_LS, std::vector<Vector3d> points) {
  for (Vector3d& p : points) p = X_LS * p;
  return points;
}

}  // namespace

HullTriangle hull_triangle(std::span<const Vector3d> points, const std::array<int, 3>& corners) {
  const auto at = [&](std::size_t k) { return points[static_cast<std::size_t>(corners[k])]; };
  return {corners, std::max((at(1) - at(0)).norm(), (at(2) - at(0)).norm())};
}

void CoverSolid::append_to(ByteKey& key) const {
  key.add(kind, X_LS, size, points, triangles.size());
  for (const HullTriangle& triangle : triangles) key.add(triangle.corners);
}

Vector3d CoverSolid::in_own_frame(const Vector3d& p_L) const {
  return X_LS.R.transpose() * (p_L - X_LS.p);
}

bool CoverSolid::is_within(const Vector3d& p_L, double distance) const {
  if (kind == SolidKind::hull) return !facets.is_beyond(in_own_frame(p_L), distance);
  return signed_distance(p_L) <= distance;
}

double CoverSolid::signed_distance(const Vector3d& p_L) const {
  const Vector3d p = in_own_frame(p_L);
  switch (kind) {
    case SolidKind::ball:
      return p.norm() - size.x();
    case SolidKind::capsule: {
      const double beyond = std::max(std::abs(p.z()) - size.y(), 0.0);
      return std::sqrt(p.x() * p.x() + p.y() * p.y() + beyond * beyond) - size.x();
    }
    case SolidKind::box:
      return from_box(size, p);
    case SolidKind::cylinder:
      return from_cylinder(size.x(), size.y(), p);
    case SolidKind::ellipsoid:
      return from_ellipsoid(size, p);
    case SolidKind::hull:
      return facets.farthest(p);
  }
  return kNoBound;
}

Vector3d CoverSolid::outwards(const Vector3d& p_L) const {
  constexpr double kStep = 1e-6;  // [m]
  std::array<Vector3d, 6> beside;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    beside[i] = p_L + kStep * Vector3d::Unit(k);
    beside[i + 3] = p_L - kStep * Vector3d::Unit(k);
  }
  std::array<double, 6> distances;
  if (kind == SolidKind::hull) {
    for (Vector3d& p : beside) p = in_own_frame(p);
    distances = facets.farthest_beside(in_own_frame(p_L), kStep, beside);
  } else {
    for (std::size_t k = 0; k < 6; ++k) distances[k] = signed_distance(beside[k]);
  }
  const Vector3d gradient(distances[0] - distances[3], distances[1] - distances[4],
                          distances[2] - distances[5]);
  const double length = gradient.norm();
  return length > 0.2 * kStep ? Vector3d(gradient / length) : Vector3d(Vector3d::Zero());
}

std::optional<Vector3d> CoverSolid::point_within(const Vector3d& p_L, double distance) const {
  const double apart = signed_distance(p_L);
  if (apart <= 0) return p_L;
  if (apart > distance) return std::nullopt;
  if (kind != SolidKind::hull) return p_L - apart * outwards(p_L);
  const Vector3d p = in_own_frame(p_L);
  Vector3d best = points.front();
  const auto vertex = [&](int index) { return points[static_cast<std::size_t>(index)]; };
  for (const auto& [corners, reach] : triangles) {
    const Vector3d a = vertex(corners[0]);
    // Most are too far away to be looked at.
    const double within = reach + distance * (1 + 1e-9) + 1e-12 * (1 + p.norm());
    if ((p - a).squaredNorm() > within * within) continue;
    const Vector3d x = nearest_on(p, a, vertex(corners[1]), vertex(corners[2]));
    if ((x - p).squaredNorm() < (best - p).squaredNorm()) best = x;
  }
  if ((best - p).norm() > distance) return std::nullopt;
  return X_LS * best;
}

std::vector<Vector3d> CoverSolid::skeleton() const {
  switch (kind) {
    case SolidKind::ball:
      return {X_LS.p};
    case SolidKind::capsule:
      return into_link(X_LS, {{0, 0, size.y()}, {0, 0, -size.y()}});
    case SolidKind::hull:
      return into_link(X_LS, points);
    default: {
      const Vector3d half = half_extents(*this);
      std::vector<Vector3d> corners;
      for (int k = 0; k < 8; ++k) {
        corners.emplace_back((k & 1) != 0 ? half.x() : -half.x(),
                             (k & 2) != 0 ? half.y() : -half.y(),
                             (k & 4) != 0 ? half.z() : -half.z());
      }
      return into_link(X_LS, corners);
    }
  }
}

std::vector<Vector3d> CoverSolid::sharp_points(double spacing) const {
  std::vector<Vector3d> out;
  if (kind == SolidKind::box) add_edges(size, spacing, out);
  if (kind == SolidKind::hull) out = points;
  if (kind == SolidKind::cylinder) {
    const int count = 8 + static_cast<int>(2 * std::numbers::pi * size.x() / spacing);
    for (const double side : {-1.0, 1.0}) add_circle(size.x(), side * size.y(), count, out);
  }
  return into_link(X_LS, std::move(out));
}

CoverBounds bounds_in_world(const Pose& X_WO, const CoverBounds& box_O) {
  const Vector3d half = X_WO.R.cwiseAbs() * (0.5 * (box_O.high - box_O.low));
  const Vector3d middle = X_WO * Vector3d(0.5 * (box_O.low + box_O.high));
  return {middle - half, middle + half};
}

CoverBounds bounds_of(std::span<const CoverSolid> solids) {
  CoverBounds out{Vector3d::Constant(kNoBound), Vector3d::Constant(-kNoBound)};
  for (const CoverSolid& solid : solids) {
    const bool is_round = solid.kind == SolidKind::ball || solid.kind == SolidKind::capsule;
    const double round = is_round ? solid.size.x() : 0;
    for (const Vector3d& p : solid.skeleton()) {
      out.low = out.low.cwiseMin(p - Vector3d::Constant(round));
      out.high = out.high.cwiseMax(p + Vector3d::Constant(round));
    }
  }
  return out;
}

double depth_in(std::span<const CoverSolid> solids, const Vector3d& p_L) {
  double depth = -kNoBound;
  for (const CoverSolid& solid : solids) depth = std::max(depth, -solid.signed_distance(p_L));
  return depth;
}

}  // namespace mjarm::detail
