#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/collision/convex_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFewPoints = 24;  // that are looked at one after the other
constexpr int kMaxSteps = 64;
constexpr double kConverged = 1e-6;  // of the distance
constexpr double kFlat = 1e-10;      // heights and areas of less count as none
constexpr double kTouching = 1e-12;  // [m]
constexpr int kMoreDirections = 64;  // in which an overlap is measured

/// The corners of a simplex between two cores (points of A less points of B), at most four.
class Simplex {
 public:
  int size() const { return size_; }
  bool has(const Vector3d& w) const {
    return std::any_of(w_.begin(), w_.begin() + size_, [&](const Vector3d& x) { return x == w; });
  }
  void add(const Vector3d& w) { w_[static_cast<std::size_t>(size_++)] = w; }

  /// Its point that is nearest to 0; corners that do not matter for that are left out.
  Vector3d reduce() {
    switch (size_) {
      case 1:
        return w_[0];
      case 2:
        return segment(w_[0], w_[1]);
      case 3:
        return triangle(w_[0], w_[1], w_[2]);
      default:
        return tetrahedron();
    }
  }

 private:
  Vector3d keep(const Vector3d& a, const Vector3d& nearest) {
    w_[0] = a;
    size_ = 1;
    return nearest;
  }
  Vector3d keep(const Vector3d a, const Vector3d b, const Vector3d& nearest) {
    w_[0] = a, w_[1] = b;
    size_ = 2;
    return nearest;
  }

  Vector3d segment(const Vector3d a, const Vector3d b) {
    const Vector3d ab = b - a;
    const double t = -a.dot(ab), whole = ab.squaredNorm();
    if (t <= 0 || whole == 0) return keep(a, a);
    if (t >= whole) return keep(b, b);
    return keep(a, b, a + t / whole * ab);
  }

  /// By the parts of the plane that belong to its corners and edges (C. Ericson, Real-Time
  /// Collision Detection, 2004, 5.1.5).
  Vector3d triangle(const Vector3d a, const Vector3d b, const Vector3d c) {
    const Vector3d ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a);
    if (d1 <= 0 && d2 <= 0) return keep(a, a);
    const double d3 = -ab.dot(b), d4 = -ac.dot(b);
    if (d3 >= 0 && d4 <= d3) return keep(b, b);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return keep(a, b, a + d1 / (d1 - d3) * ab);
    const double d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d6 >= 0 && d5 <= d6) return keep(c, c);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return keep(a, c, a + d2 / (d2 - d6) * ac);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
      return keep(b, c, b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
    }
    const Vector3d normal = ab.cross(ac);
    const double area2 = normal.squaredNorm();
    if (area2 <= kFlat * kFlat * ab.squaredNorm() * ac.squaredNorm()) return sides(a, b, c);
    w_[0] = a, w_[1] = b, w_[2] = c;
    size_ = 3;
    return normal.dot(a) / area2 * normal;
  }

  /// Of three points on a line.
  Vector3d sides(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    Vector3d nearest = segment(a, b);
    Simplex best = *this;
    for (const auto& [from, to] : {std::pair{&b, &c}, {&a, &c}}) {
      const Vector3d p = segment(*from, *to);
      if (p.squaredNorm() < nearest.squaredNorm()) nearest = p, best = *this;
    }
    *this = best;
    return nearest;
  }

  /// By its faces: those that have 0 on their outer side, all of them where it is flat.
  Vector3d tetrahedron() {
    static constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
    const std::array<Vector3d, 4> w = w_;
    Simplex best;
    Vector3d nearest = Vector3d::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const auto& face : kFaces) {
      const Vector3d &a = w[face[0]], &b = w[face[1]], &c = w[face[2]], &d = w[face[3]];
      const Vector3d normal = (b - a).cross(c - a);
      const double height = normal.dot(d - a);
      const bool is_flat = std::abs(height) <= kFlat * normal.norm() * (d - a).norm();
      if (!is_flat && normal.dot(-a) * height >= 0) continue;
      Simplex part;
      const Vector3d p = part.triangle(a, b, c);
      if (p.squaredNorm() >= least) continue;
      least = p.squaredNorm();
      nearest = p;
      best = part;
    }
    if (best.size_ > 0) *this = best;
    return nearest;
  }

  std::array<Vector3d, 4> w_;
  int size_ = 0;
};

/// R p and its inverse; Eigen's own are called, not inlined, as often as this is needed.
Vector3d turn(const Eigen::Matrix3d& R, const Vector3d& p) {
  return {R(0, 0) * p.x() + R(0, 1) * p.y() + R(0, 2) * p.z(),
          R(1, 0) * p.x() + R(1, 1) * p.y() + R(1, 2) * p.z(),
          R(2, 0) * p.x() + R(2, 1) * p.y() + R(2, 2) * p.z()};
}
Vector3d turn_back(const Eigen::Matrix3d& R, const Vector3d& p) {
  return {R(0, 0) * p.x() + R(1, 0) * p.y() + R(2, 0) * p.z(),
          R(0, 1) * p.x() + R(1, 1) * p.y() + R(2, 1) * p.z(),
          R(0, 2) * p.x() + R(1, 2) * p.y() + R(2, 2) * p.z()};
}

/// A core in the world.
class Placed {
 public:
  Placed(const Convex& convex, const Pose& X_WL)
      : convex_(convex),
        R_(X_WL.R * convex.frame().R),
        p_(turn(X_WL.R, convex.frame().p) + X_WL.p) {}
  Vector3d farthest(const Vector3d& n) {
    return turn(R_, convex_.farthest(turn_back(R_, n), hint_)) + p_;
  }

 private:
  const Convex& convex_;
  Eigen::Matrix3d R_;
  Vector3d p_;
  int hint_ = 0;
};

}  // namespace

Convex::Convex(const CoverSolid& solid) : kind_(solid.kind), X_LS_(solid.X_LS), size_(solid.size) {
  center_ = X_LS_.p;
  switch (kind_) {
    case SolidKind::ball:
      radius_ = size_.x();
      break;
    case SolidKind::capsule:
      radius_ = size_.x();
      reach_ = size_.y();
      break;
    case SolidKind::cylinder:
      reach_ = std::hypot(size_.x(), size_.y());
      normals_ = {X_LS_.R.col(2)};
      break;
    case SolidKind::box:
      reach_ = size_.norm();
      for (int k = 0; k < 3; ++k) normals_.emplace_back(X_LS_.R.col(k));
      break;
    case SolidKind::ellipsoid:
      reach_ = size_.maxCoeff();
      break;
    case SolidKind::hull: {
      Vector3d low = solid.points.front(), high = low;
      for (const Vector3d& p : solid.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
      center_ = X_LS_ * Vector3d(0.5 * (low + high));
      for (const Vector3d& p : solid.points) {
        points_.push_back(X_LS_ * p);
        reach_ = std::max(reach_, (points_.back() - center_).norm());
      }
      for (std::size_t k = 0; k < solid.facets.size(); ++k) {
        normals_.emplace_back(X_LS_.R * solid.facets[k].normal);
      }
      if (points_.size() > kFewPoints) join(solid.triangles);
      X_LS_ = Pose();
      break;
    }
  }
}

Convex::Convex(std::span<const Vector3d> points) : points_(points.begin(), points.end()) {
  for (const Vector3d& p : points) center_ += p / static_cast<double>(points.size());
  for (const Vector3d& p : points) reach_ = std::max(reach_, (p - center_).norm());
}

/// Notes which points the edges of the surface join.
void Convex::join(const std::vector<HullTriangle>& triangles) {
  std::vector<std::vector<int>> beside(points_.size());
  for (const auto& [corners, reach] : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      beside[static_cast<std::size_t>(corners[k])].push_back(corners[(k + 1) % 3]);
      beside[static_cast<std::size_t>(corners[(k + 1) % 3])].push_back(corners[k]);
    }
  }
  first_ = {0};
  for (std::vector<int>& near : beside) {
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    neighbours_.insert(neighbours_.end(), near.begin(), near.end());
    first_.push_back(static_cast<int>(neighbours_.size()));
  }
}

void Convex::append_to(ByteKey& key) const {
  key.add(kind_, X_LS_, size_, radius_, center_, reach_, points_);
}

/// Over the surface from point to point, as long as it goes up.
int Convex::climb(const Vector3d& n, int from) const noexcept {
  double high = n.dot(points_[static_cast<std::size_t>(from)]);
  for (bool higher = true; higher;) {
    higher = false;
    const auto at = static_cast<std::size_t>(from);
    for (int k = first_[at]; k < first_[at + 1]; ++k) {
      const int other = neighbours_[static_cast<std::size_t>(k)];
      const double height = n.dot(points_[static_cast<std::size_t>(other)]);
      if (height <= high) continue;
      high = height;
      from = other;
      higher = true;
    }
  }
  return from;
}

Vector3d Convex::farthest(const Vector3d& n, int& hint) const noexcept {
  switch (kind_) {
    case SolidKind::ball:
      return Vector3d::Zero();
    case SolidKind::capsule:
      return {0, 0, n.z() < 0 ? -size_.y() : size_.y()};
    case SolidKind::cylinder: {
      const double side = std::sqrt(n.x() * n.x() + n.y() * n.y());
      const double share = side > 0 ? size_.x() / side : 0;
      return {share * n.x(), share * n.y(), n.z() < 0 ? -size_.y() : size_.y()};
    }
    case SolidKind::ellipsoid: {
      const Vector3d scaled = size_.cwiseProduct(n);
      return size_.cwiseProduct(scaled) / scaled.norm();
    }
    case SolidKind::box:
      return {n.x() < 0 ? -size_.x() : size_.x(), n.y() < 0 ? -size_.y() : size_.y(),
              n.z() < 0 ? -size_.z() : size_.z()};
    case SolidKind::hull:
      break;
  }
  if (!first_.empty()) {
    hint = climb(n, hint);
    return points_[static_cast<std::size_t>(hint)];
  }
  const auto height = [&](const Vector3d& p) { return n.dot(p); };
  return *std::ranges::max_element(points_, {}, height);
}

Sphere Convex::inscribed_ball() const {
  switch (kind_) {
    case SolidKind::ball:
    case SolidKind::capsule:
      return {center_, radius_};
    case SolidKind::cylinder:
      return {center_, std::min(size_.x(), size_.y())};
    case SolidKind::box:
    case SolidKind::ellipsoid:
      return {center_, size_.minCoeff()};
    case SolidKind::hull:
      break;
  }
  return normals_.empty() ? Sphere{center_, 0} : ball_between_faces();
}

/// Steps away from the nearest face that get shorter and shorter.
Sphere Convex::ball_between_faces() const {
  constexpr int kSteps = 300;
  std::vector<double> offsets;
  for (const Vector3d& n : normals_) {
    const auto height = [&](const Vector3d& p) { return n.dot(p); };
    offsets.push_back(height(*std::ranges::max_element(points_, {}, height)));
  }
  Sphere best{center_, 0};
  Vector3d p = Vector3d::Zero();
  for (const Vector3d& point : points_) p += point / static_cast<double>(points_.size());
  for (int step = 1; step <= kSteps; ++step) {
    double depth = std::numeric_limits<double>::infinity();
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < normals_.size(); ++k) {
      const double to_face = offsets[k] - normals_[k].dot(p);
      if (to_face < depth) depth = to_face, nearest = k;
    }
    if (depth > best.radius) best = {p, depth};
    p -= normals_[nearest] * (0.5 * reach_ / step);
  }
  return best;
}

Separation separate(const Convex& a, const Pose& X_WA, const Convex& b, const Pose& X_WB,
                    const SeparateLimits& limits) noexcept {
  Separation out;
  Vector3d v = turn(X_WA.R, a.center()) + X_WA.p - turn(X_WB.R, b.center()) - X_WB.p;
  const double centers = v.norm(), balls = centers - a.reach() - b.reach();
  if (balls > limits.enough) return {balls, v / centers, out.distance};
  if (centers == 0) v = Vector3d::UnitX();
  Placed placed_a(a, X_WA), placed_b(b, X_WB);
  Simplex simplex;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vector3d n = v / v.norm();
    const Vector3d w = placed_a.farthest(-n) - placed_b.farthest(n);
    const double gap = n.dot(w);
    if (gap > out.gap) out.gap = gap, out.normal = n;
    if (out.gap > limits.enough) return out;
    if (out.gap >= (1 - kConverged) * out.distance || simplex.has(w)) return out;
    simplex.add(w);
    v = simplex.reduce();
    const double distance = simplex.size() == 4 ? 0 : v.norm();
    const bool nearer = distance < out.distance;
    out.distance = std::min(out.distance, distance);
    if (distance <= kTouching) out.distance = 0;
    if (!nearer || out.distance <= limits.too_near) return out;
  }
  return out;
}

double depth_of_overlap(const Convex& a, const Pose& X_WA, const Convex& b,
                        const Pose& X_WB) noexcept {
  double least = std::numeric_limits<double>::infinity();
  Placed placed_a(a, X_WA), placed_b(b, X_WB);
  const auto look = [&](const Vector3d& n) {
    least = std::min(least, n.dot(placed_b.farthest(n) - placed_a.farthest(-n)));
  };
  for (const auto& [X, solid] : {std::pair{&X_WA, &a}, {&X_WB, &b}}) {
    for (const Vector3d& normal : solid->normals()) {
      look(X->R * normal);
      look(-(X->R * normal));
    }
  }
  const Vector3d apart = X_WA * a.center() - X_WB * b.center();
  if (apart.norm() > 0) look(apart.normalized());
  // Points on a spiral are spread evenly over a sphere.
  for (int k = 0; k < kMoreDirections; ++k) {
    const double z = 1 - (2 * k + 1.0) / kMoreDirections, side = std::sqrt(1 - z * z);
    const double angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
    look({side * std::cos(angle), side * std::sin(angle), z});
  }
  return least + a.radius() + b.radius();
}

}  // namespace mjarm::detail
