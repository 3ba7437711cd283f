#include "mjarm/model/object_shape.hpp"

#include <optional>

#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/mesh_table_internal.hpp"

namespace mjarm {
namespace {

using Eigen::Vector3d;

/// The convex hull of a mesh, in which form it collides; the mesh itself where it has none.
void add_hull(const mjModel* m, int mesh, ShapePart& part) {
  const MeshTable table(*m, mesh);
  const int at = m->mesh_graphadr[mesh];
  if (at < 0) {
    for (int k = 0; k < table.vertex_count; ++k) part.vertices.push_back(table.vertex(k));
    for (int f = 0; f < table.face_count; ++f) part.faces.push_back(table.face(f));
    return;
  }
  // numvert, numface, vert_edgeadr, vert_globalid, edge_localid, face_globalid.
  const int* graph = m->mesh_graph + at;
  const int count = graph[0], faces = graph[1];
  const int* global = graph + 2 + count;
  const int* face = graph + 2 + 2 * count + count + 3 * faces;
  std::vector<int> local(static_cast<std::size_t>(table.vertex_count), 0);
  for (int k = 0; k < count; ++k) {
    local[static_cast<std::size_t>(global[k])] = k;
    part.vertices.push_back(table.vertex(global[k]));
  }
  for (int f = 0; f < faces; ++f) {
    std::array<int, 3> corners{};
    for (int k = 0; k < 3; ++k) corners[k] = local[static_cast<std::size_t>(face[3 * f + k])];
    part.faces.push_back(corners);
  }
}

std::optional<ShapePart> part_of(const mjModel* m, int geom) {
  using Kind = ShapePart::Kind;
  ShapePart part;
  part.size = Vector3d(m->geom_size + 3 * geom);
  switch (m->geom_type[geom]) {
    case mjGEOM_BOX:
      part.kind = Kind::box;
      return part;
    case mjGEOM_CYLINDER:
      part.kind = Kind::cylinder;
      return part;
    case mjGEOM_CAPSULE:
      part.kind = Kind::capsule;
      return part;
    case mjGEOM_SPHERE:
      part.kind = Kind::ball;
      return part;
    case mjGEOM_ELLIPSOID:
      part.kind = Kind::ellipsoid;
      return part;
    case mjGEOM_MESH:
      part.kind = Kind::hull;
      add_hull(m, m->geom_dataid[geom], part);
      return part;
    default:
      return std::nullopt;
  }
}

/// Calls `visit(k, X_BK)` for a body and all that hangs on it.
template <class Visit>
void visit_below(const mjModel* m, int body, const Visit& visit) {
  std::vector<std::optional<Pose>> X_BK(static_cast<std::size_t>(m->nbody));
  X_BK[static_cast<std::size_t>(body)] = Pose();
  for (int k = body; k < static_cast<int>(m->nbody); ++k) {  // parents come before children
    auto& here = X_BK[static_cast<std::size_t>(k)];
    if (const auto& parent = X_BK[static_cast<std::size_t>(m->body_parentid[k])];
        k > body && parent) {
      here = *parent * pose_of(m->body_pos + 3 * k, m->body_quat + 4 * k);
    }
    if (here) visit(k, *here);
  }
}

}  // namespace

ObjectMass object_mass(const Model& model, int body) {
  const mjModel* m = model.raw();
  ObjectMass out;
  visit_below(m, body, [&](int k, const Pose& X_BK) {
    out.mass += m->body_mass[k];
    out.center_B += m->body_mass[k] * (X_BK * Vector3d(m->body_ipos + 3 * k));
  });
  if (out.mass > 0) out.center_B /= out.mass;
  return out;
}

ObjectShape object_shape(const Model& model, int body) {
  const mjModel* m = model.raw();
  ObjectShape shape{object_mass(model, body), {}};
  visit_below(m, body, [&](int k, const Pose& X_BK) {
    for (int g = m->body_geomadr[k]; g < m->body_geomadr[k] + m->body_geomnum[k]; ++g) {
      if (m->geom_contype[g] == 0 && m->geom_conaffinity[g] == 0) continue;
      std::optional<ShapePart> part = part_of(m, g);
      if (!part) continue;
      part->X_BG = X_BK * pose_of(m->geom_pos + 3 * g, m->geom_quat + 4 * g);
      shape.parts.push_back(std::move(*part));
    }
  });
  return shape;
}

}  // namespace mjarm
