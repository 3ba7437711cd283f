#include <algorithm>
#include <map>
#include <vector>

#include "mjarm/collision/cover_geoms_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

/// The bounding box that MuJoCo keeps of every geom.
Pose box_frame(const mjModel& m, const PlacedGeom& placed) {
  return placed.X_LG * Pose{Vector3d(m.geom_aabb + 6 * placed.geom), Eigen::Matrix3d::Identity()};
}
Vector3d box_half(const mjModel& m, int geom) {
  return Vector3d(m.geom_aabb + 6 * geom + 3).cwiseMax(1e-6);
}

/// Points in groups of those that are near each other, of which most need not be looked at.
class PointGroups {
 public:
  explicit PointGroups(const std::vector<Vector3d>& points) : points_(points) {
    split(points_.begin(), points_.end());
  }

  /// The largest normal . p, or `least` where that is larger; `normal` is unit.
  [[nodiscard]] double farthest(const Vector3d& normal, double least) const {
    for (const Group& group : groups_) {
      if (normal.dot(group.middle) + group.reach < least) continue;
      for (std::size_t k = group.first; k < group.last; ++k) {
        least = std::max(least, normal.dot(points_[k]));
      }
    }
    return least;
  }

 private:
  struct Group {
    Vector3d middle;
    double reach;             // [m] all are nearer to the middle, rounding and all
    std::size_t first, last;  // of points_
  };
  using At = std::vector<Vector3d>::iterator;

  void split(At first, At last) {
    constexpr std::ptrdiff_t kFewVertices = 16;
    Vector3d low = *first, high = low;
    for (At p = first; p != last; ++p) low = low.cwiseMin(*p), high = high.cwiseMax(*p);
    if (last - first > kFewVertices) {
      Eigen::Index axis = 0;
      (high - low).maxCoeff(&axis);
      const At half = first + (last - first) / 2;
      std::nth_element(first, half, last,
                       [&](const Vector3d& a, const Vector3d& b) { return a[axis] < b[axis]; });
      split(first, half);
      split(half, last);
      return;
    }
    const Vector3d middle = 0.5 * (low + high);
    const double reach = 0.5 * (high - low).norm();
    groups_.push_back({middle, reach + 1e-12 * (1 + middle.norm() + reach),
                       static_cast<std::size_t>(first - points_.begin()),
                       static_cast<std::size_t>(last - points_.begin())});
  }

  std::vector<Vector3d> points_;
  std::vector<Group> groups_;
};

/// The planes of a hull's faces, those of faces in one plane once.
class FacePlanes {
 public:
  /// @param points  all vertices, at least one.
  explicit FacePlanes(const std::vector<Vector3d>& points) : groups_(points) {
    for (const Vector3d& p : points) inside_ += p / static_cast<double>(points.size());
  }

  /// The plane through three vertices, so far out that all points are behind it.
  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    Vector3d normal = (b - a).cross(c - a);
    const double area = normal.norm();
    if (!(area > 1e-12 * std::max((b - a).squaredNorm(), (c - a).squaredNorm()))) return;
    normal /= area;
    if (normal.dot(a - inside_) < 0) normal = -normal;
    if (is_known(normal)) return;
    along_.emplace(normal.dot(kAnyWay), normal);
    out_.push_back({normal, groups_.farthest(normal, normal.dot(a))});
  }

  std::vector<Facet> take() { return std::move(out_); }

 private:
  /// Only normals that are about as long in some direction can be about the same.
  [[nodiscard]] bool is_known(const Vector3d& normal) const {
    constexpr double kBeside = 1e-4;  // more than the distance of what counts as the same
    const double along = normal.dot(kAnyWay);
    const auto end = along_.upper_bound(along + kBeside);
    for (auto at = along_.lower_bound(along - kBeside); at != end; ++at) {
      if (at->second.dot(normal) > 1 - 1e-9) return true;
    }
    return false;
  }

  static inline const Vector3d kAnyWay{0.48, 0.6, 0.64};  // that few normals are at right angles to
  PointGroups groups_;
  Vector3d inside_ = Vector3d::Zero();
  std::vector<Facet> out_;
  std::multimap<double, Vector3d> along_;
};

/// The convex hull that MuJoCo keeps of a mesh: numbers of vertices and faces, then per vertex
/// where its edges start and which vertex of the mesh it is, the edges, and the faces.
bool add_hull(const mjModel& m, int mesh, CoverSolid& out) {
  if (m.mesh_graphadr[mesh] < 0) return false;
  const int* const graph = m.mesh_graph + m.mesh_graphadr[mesh];
  const int vertices = graph[0], faces = graph[1];
  if (vertices <= 0) return false;
  const int* const ids = graph + 2 + vertices;
  const int* const corners = graph + 2 + 3 * vertices + 3 * faces;
  const auto vertex = [&](int id) {
    return Vector3d(Eigen::Map<const Eigen::Vector3f>(m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + id))
                        .cast<double>());
  };
  std::vector<int> index_of(static_cast<std::size_t>(m.mesh_vertnum[mesh]), 0);
  for (int k = 0; k < vertices; ++k) {
    index_of[static_cast<std::size_t>(ids[k])] = k;
    out.points.push_back(vertex(ids[k]));
  }
  FacePlanes planes(out.points);
  for (int f = 0; f < faces; ++f) {
    const int* const c = corners + 3 * f;
    const auto index = [&](int i) { return index_of[static_cast<std::size_t>(c[i])]; };
    out.triangles.push_back(hull_triangle(out.points, {index(0), index(1), index(2)}));
    planes.add(vertex(c[0]), vertex(c[1]), vertex(c[2]));
  }
  out.facets = Facets(planes.take());
  return out.facets.size() >= 4;
}

/// Sizes of a field: half extents along x and y, height of the highest point, and of the base
/// below.
HeightFieldShape height_field(const mjModel& m, int field) {
  HeightFieldShape out;
  out.rows = m.hfield_nrow[field];
  out.cols = m.hfield_ncol[field];
  const mjtNum* const size = m.hfield_size + 4 * field;
  out.half = {size[0], size[1]};
  out.bottom = -size[3];
  const float* const data = m.hfield_data + m.hfield_adr[field];
  for (int k = 0; k < out.rows * out.cols; ++k) {
    out.heights.push_back(size[2] * static_cast<double>(data[k]));
  }
  return out;
}

}  // namespace

CoverSolid solid_of_geom(const mjModel& m, const PlacedGeom& placed) {
  const int geom = placed.geom;
  CoverSolid out;
  out.X_LS = placed.X_LG;
  out.size = Vector3d(m.geom_size + 3 * geom);
  switch (m.geom_type[geom]) {
    case mjGEOM_SPHERE:
      out.kind = SolidKind::ball;
      return out;
    case mjGEOM_CAPSULE:
      out.kind = SolidKind::capsule;
      return out;
    case mjGEOM_CYLINDER:
      out.kind = SolidKind::cylinder;
      return out;
    case mjGEOM_BOX:
      out.kind = SolidKind::box;
      return out;
    case mjGEOM_ELLIPSOID:
      out.kind = SolidKind::ellipsoid;
      return out;
    case mjGEOM_MESH:
      out.kind = SolidKind::hull;
      if (add_hull(m, m.geom_dataid[geom], out)) return out;
      break;
    default:
      break;
  }
  CoverSolid box;
  box.kind = SolidKind::box;
  box.X_LS = box_frame(m, placed);
  box.size = box_half(m, geom);
  return box;
}

Obstacle obstacle_of_geom(const mjModel& m, const PlacedGeom& placed) {
  const int geom = placed.geom;
  const mjtNum* const size = m.geom_size + 3 * geom;
  Obstacle out{geom_name(m, geom), placed.X_LG, HalfSpaceShape{}};
  ObstacleShape& shape = out.shape;
  switch (m.geom_type[geom]) {
    case mjGEOM_PLANE:
      return out;
    case mjGEOM_SPHERE:
      shape = BallShape{size[0]};
      return out;
    case mjGEOM_CAPSULE:
      shape = CapsuleShape{size[0], size[1]};
      return out;
    case mjGEOM_CYLINDER:
      shape = CylinderShape{size[0], size[1]};
      return out;
    case mjGEOM_BOX:
      shape = BoxShape{Vector3d(size)};
      return out;
    default:
      break;
  }
  if (m.geom_type[geom] == mjGEOM_HFIELD) {
    shape = height_field(m, m.geom_dataid[geom]);
    return out;
  }
  if (m.geom_type[geom] == mjGEOM_MESH) {
    const CoverSolid hull = solid_of_geom(m, placed);
    Result<PolytopeShape> polytope = make_polytope(hull.points);
    if (hull.kind == SolidKind::hull && polytope) {
      shape = std::move(*polytope);
      return out;
    }
  }
  out.X_WO = box_frame(m, placed);
  shape = BoxShape{box_half(m, geom)};
  return out;
}

}  // namespace mjarm::detail
