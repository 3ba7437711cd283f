#include <algorithm>
#include <map>

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

/// Appends the plane through three vertices, so far out that all `points` are behind it.
void add_facet(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& inside,
               CoverSolid& out) {
  Vector3d normal = (b - a).cross(c - a);
  const double area = normal.norm();
  if (!(area > 1e-12 * std::max((b - a).squaredNorm(), (c - a).squaredNorm()))) return;
  normal /= area;
  if (normal.dot(a - inside) < 0) normal = -normal;
  for (std::size_t k = 0; k < out.facets.size(); ++k) {
    if (out.facets[k].normal.dot(normal) > 1 - 1e-9) return;
  }
  double offset = normal.dot(a);
  for (const Vector3d& p : out.points) offset = std::max(offset, normal.dot(p));
  out.facets.add({normal, offset});
}

/// The convex hull that MuJoCo keeps of a mesh: numbers of vertices and faces, then per vertex
/// where its edges start and which vertex of the mesh it is, the edges, and the faces.
bool add_hull(const mjModel& m, int mesh, CoverSolid& out) {
  if (m.mesh_graphadr[mesh] < 0) return false;
  const int* const graph = m.mesh_graph + m.mesh_graphadr[mesh];
  const int vertices = graph[0], faces = graph[1];
  const int* const ids = graph + 2 + vertices;
  const int* const corners = graph + 2 + 3 * vertices + 3 * faces;
  const auto vertex = [&](int id) {
    return Vector3d(Eigen::Map<const Eigen::Vector3f>(m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + id))
                        .cast<double>());
  };
  Vector3d inside = Vector3d::Zero();
  std::map<int, int> index_of;
  for (int k = 0; k < vertices; ++k) {
    index_of[ids[k]] = k;
    out.points.push_back(vertex(ids[k]));
    inside += out.points.back() / vertices;
  }
  for (int f = 0; f < faces; ++f) {
    const int* const c = corners + 3 * f;
    out.triangles.push_back({index_of[c[0]], index_of[c[1]], index_of[c[2]]});
    add_facet(vertex(c[0]), vertex(c[1]), vertex(c[2]), inside, out);
  }
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
