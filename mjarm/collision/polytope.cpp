#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "mjarm/collision/obstacles.hpp"
#include "mjarm/core/messages/collision.hpp"

namespace mjarm {
namespace {

constexpr std::size_t kMaxHullPoints = 10'000;
constexpr double kMaxExtent = 1e4;       // [m]
constexpr double kEdgeStep = 0.35;       // [rad] between planes round an edge
constexpr double kSameNormal = 1e-3;     // [rad] two planes that count as one
constexpr std::size_t kFacePlanes = 80;  // at most

struct HullFace {
  std::array<int, 3> corner;
  Eigen::Vector3d n;
  double d;
};

/// The convex hull, point by point. Rounding may leave it a little wrong, which costs tightness
/// only: every plane is moved out to touch the points afterwards.
class Hull {
 public:
  explicit Hull(std::span<const Eigen::Vector3d> points) : points_(points) {
    if (!start()) return;
    for (int i = 0; i < std::ssize(points_) && std::ssize(faces_) < 20'000; ++i) add(i);
  }
  const std::vector<HullFace>& faces() const { return faces_; }

 private:
  const Eigen::Vector3d& at(int i) const { return points_[static_cast<std::size_t>(i)]; }

  template <class Value>
  int farthest(const Value& value) const {
    int best = 0;
    for (int i = 1; i < std::ssize(points_); ++i) best = value(at(i)) > value(at(best)) ? i : best;
    return best;
  }

  /// A tetrahedron; false where all points are in a plane.
  bool start() {
    const int a = farthest([](const Eigen::Vector3d& p) { return p.x(); });
    const int b = farthest([&](const Eigen::Vector3d& p) { return (p - at(a)).norm(); });
    const Eigen::Vector3d way = at(b) - at(a);
    const auto off_line = [&](const Eigen::Vector3d& p) { return way.cross(p - at(a)).norm(); };
    const int c = farthest(off_line);
    const Eigen::Vector3d n = way.cross(at(c) - at(a));
    const auto off_plane = [&](const Eigen::Vector3d& p) { return std::abs(n.dot(p - at(a))); };
    const int d = farthest(off_plane);
    const double size = way.norm();
    spare_ = 1e-10 * size;
    if (off_line(at(c)) <= 1e-8 * size * size || off_plane(at(d)) <= 1e-8 * size * n.norm()) {
      return false;
    }
    middle_ = 0.25 * (at(a) + at(b) + at(c) + at(d));
    for (const auto& [i, j, k] : {std::array{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}) {
      add_face(i, j, k);
    }
    return true;
  }

  void add_face(int a, int b, int c) {
    Eigen::Vector3d n = (at(b) - at(a)).cross(at(c) - at(a)).normalized();
    if (n.dot(at(a) - middle_) < 0) {
      n = -n;
      std::swap(b, c);
    }
    faces_.push_back({{a, b, c}, n, n.dot(at(a))});
  }

  void add(int i) {
    std::set<std::array<int, 2>> rim;
    const auto seen = [&](const HullFace& face) { return face.n.dot(at(i)) > face.d + spare_; };
    for (const HullFace& face : faces_) {
      if (!seen(face)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array edge{face.corner[k], face.corner[(k + 1) % 3]};
        if (rim.erase({edge[1], edge[0]}) == 0) rim.insert(edge);
      }
    }
    if (rim.empty()) return;
    std::erase_if(faces_, seen);
    for (const auto& [a, b] : rim) add_face(a, b, i);
  }

  std::span<const Eigen::Vector3d> points_;
  std::vector<HullFace> faces_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double spare_ = 0;
};

/// What is flat gets a hull of its own by a few points beside it.
void thicken(std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) middle += p / static_cast<double>(points.size());
  double size = 0;
  for (const Eigen::Vector3d& p : points) size = std::max(size, (p - middle).norm());
  for (Eigen::Index k = 0; k < 3; ++k) {
    points.push_back(middle + 1e-3 * size * Eigen::Vector3d::Unit(k));
    points.push_back(middle - 1e-3 * size * Eigen::Vector3d::Unit(k));
  }
}

/// Planes in chosen directions.
class PlaneList {
 public:
  explicit PlaneList(std::span<const Eigen::Vector3d> points) : points_(points) {}

  bool is_new(const Eigen::Vector3d& n, double angle) const {
    return std::none_of(planes_.begin(), planes_.end(), [&](const Eigen::Vector4d& plane) {
      return (plane.head<3>() - n).norm() < angle;
    });
  }

  void add(const Eigen::Vector3d& n, double angle = kSameNormal) {
    if (planes_.size() >= kMaxPlanes || !is_new(n, angle)) return;
    double d = n.dot(points_.front());
    for (const Eigen::Vector3d& p : points_) d = std::max(d, n.dot(p));
    planes_.push_back({n.x(), n.y(), n.z(), d});
  }

  std::vector<Eigen::Vector4d> take() { return std::move(planes_); }
  std::size_t size() const { return planes_.size(); }

 private:
  std::span<const Eigen::Vector3d> points_;
  std::vector<Eigen::Vector4d> planes_;
};

/// Faces by size, so that small ones are left out first.
void add_faces(std::span<const Eigen::Vector3d> points, std::vector<HullFace> faces,
               PlaneList& planes) {
  const auto area = [&](const HullFace& face) {
    const auto corner = [&](std::size_t k) {
      return points[static_cast<std::size_t>(face.corner[k])];
    };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  };
  std::sort(faces.begin(), faces.end(),
            [&](const HullFace& a, const HullFace& b) { return area(a) > area(b); });
  // Ever more alike, until there are enough.
  for (const double angle : {0.5, 0.25, 0.1, kSameNormal}) {
    for (const HullFace& face : faces) {
      if (planes.size() < kFacePlanes) planes.add(face.n, angle);
    }
  }
}

/// Between the normals of two faces that share an edge.
void add_edges(const std::vector<HullFace>& faces, PlaneList& planes) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      const auto& a = faces[i].corner;
      const auto& b = faces[j].corner;
      const auto shared = std::count_if(
          a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
      if (shared != 2) continue;
      const Eigen::Vector3d axis = faces[i].n.cross(faces[j].n);
      const double angle = std::atan2(axis.norm(), faces[i].n.dot(faces[j].n));
      const int parts = static_cast<int>(std::ceil(angle / kEdgeStep));
      for (int k = 1; k < parts; ++k) {
        planes.add(Eigen::AngleAxisd(angle * k / parts, axis.normalized()) * faces[i].n, 0.05);
      }
    }
  }
}

/// About evenly in all directions (a spiral: E. Saff and A. Kuijlaars, 1997).
void add_all_round(PlaneList& planes) {
  constexpr int kCount = 100;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1 - (2 * i + 1.0) / kCount;
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * i;
    const double r = std::sqrt(1 - z * z);
    planes.add({r * std::cos(turn), r * std::sin(turn), z});
  }
}

}  // namespace

Result<PolytopeShape> make_polytope(std::span<const Eigen::Vector3d> points) {
  const auto fits = [](const Eigen::Vector3d& p) {
    return p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxExtent;
  };
  if (points.empty() || points.size() > kMaxHullPoints ||
      !std::all_of(points.begin(), points.end(), fits)) {
    return fail(Errc::bad_input,
                text(msg::collision_polytope_points, points.size(), kMaxHullPoints));
  }
  std::vector<Eigen::Vector3d> corners(points.begin(), points.end());
  std::vector<HullFace> faces = Hull(corners).faces();
  if (faces.empty()) {
    thicken(corners);
    faces = Hull(corners).faces();
  }
  PlaneList planes(points);
  add_faces(corners, faces, planes);
  add_all_round(planes);
  if (faces.size() <= 1000) add_edges(faces, planes);
  PolytopeShape out;
  out.low = out.high = points.front();
  for (const Eigen::Vector3d& p : points) {
    out.low = out.low.cwiseMin(p);
    out.high = out.high.cwiseMax(p);
  }
  out.planes = planes.take();
  return out;
}

}  // namespace mjarm
