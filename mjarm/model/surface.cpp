#include "mjarm/model/surface.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/mesh_table_internal.hpp"

namespace mjarm {
namespace {

constexpr int kAround = 64;      // faces about an axis
constexpr int kHalfAround = 16;  // rows of faces from the equator to a pole
constexpr int kLastGroupSeen = 2;

/// A corner of a triangle and the ways to the other two.
struct Sides {
  Sides(const Surface& surface, const std::array<int, 3>& triangle)
      : p(surface.vertices[static_cast<std::size_t>(triangle[0])]),
        a(surface.vertices[static_cast<std::size_t>(triangle[1])] - p),
        b(surface.vertices[static_cast<std::size_t>(triangle[2])] - p) {}
  Eigen::Vector3d p, a, b;
};

/// Turns a curve (r, z), from the lower end of the z axis to its upper one, about that axis; both
/// ends lie on it. Without the volume that flat faces cut away the radius is a little larger.
Surface turned(const std::vector<Eigen::Vector2d>& curve) {
  const double step = 2 * std::numbers::pi / kAround;
  const double stretch = std::sqrt(step / std::sin(step));
  Surface out;
  out.vertices.emplace_back(0, 0, curve.front().y());
  const int rings = static_cast<int>(curve.size()) - 2;
  for (int ring = 1; ring <= rings; ++ring) {
    const Eigen::Vector2d& at = curve[static_cast<std::size_t>(ring)];
    for (int i = 0; i < kAround; ++i) {
      out.vertices.emplace_back(stretch * at.x() * std::cos(step * i),
                                stretch * at.x() * std::sin(step * i), at.y());
    }
  }
  out.vertices.emplace_back(0, 0, curve.back().y());
  const auto vertex = [](int ring, int i) { return 1 + (ring - 1) * kAround + i % kAround; };
  const int top = static_cast<int>(out.vertices.size()) - 1;
  for (int i = 0; i < kAround; ++i) {
    out.triangles.push_back({0, vertex(1, i + 1), vertex(1, i)});
    for (int ring = 1; ring < rings; ++ring) {
      out.triangles.push_back({vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1)});
      out.triangles.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring + 1, i)});
    }
    out.triangles.push_back({vertex(rings, i), vertex(rings, i + 1), top});
  }
  return out;
}

/// A ball, stretched along z by a straight part: a capsule.
Surface round_surface(double radius, double half_straight) {
  std::vector<Eigen::Vector2d> curve;
  for (int i = -kHalfAround; i <= kHalfAround; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kHalfAround;
    const double z = radius * std::sin(angle);
    const double r = radius * std::cos(angle);
    if (i <= 0) curve.emplace_back(r, z - half_straight);
    if (i > 0 || (i == 0 && half_straight > 0)) curve.emplace_back(r, z + half_straight);
  }
  return turned(curve);
}

Surface mesh_surface(const mjModel& m, int mesh) {
  Surface out;
  const MeshTable table(m, mesh);
  for (int i = 0; i < table.vertex_count; ++i) out.vertices.push_back(table.vertex(i));
  for (int i = 0; i < table.face_count; ++i) out.triangles.push_back(table.face(i));
  return out;
}

/// In the geom's frame; nothing for planes and height fields.
std::optional<Surface> geom_surface(const mjModel& m, int geom) {
  const mjtNum* size = m.geom_size + 3 * geom;
  switch (m.geom_type[geom]) {
    case mjGEOM_BOX:
      return box_surface({size[0], size[1], size[2]});
    case mjGEOM_CYLINDER:
      return cylinder_surface(size[0], size[1]);
    case mjGEOM_SPHERE:
      return round_surface(size[0], 0);
    case mjGEOM_CAPSULE:
      return round_surface(size[0], size[1]);
    case mjGEOM_ELLIPSOID: {
      Surface ball = round_surface(1, 0);
      for (Eigen::Vector3d& v : ball.vertices)
        v = v.cwiseProduct(Eigen::Vector3d(size[0], size[1], size[2]));
      return ball;
    }
    case mjGEOM_MESH:
      return mesh_surface(m, m.geom_dataid[geom]);
    default:
      return std::nullopt;
  }
}

bool is_seen(const mjModel& m, int geom) {
  const int material = m.geom_matid[geom];
  const float alpha = material >= 0 ? m.mat_rgba[4 * material + 3] : m.geom_rgba[4 * geom + 3];
  return m.geom_group[geom] <= kLastGroupSeen && alpha > 0;
}

int body_number(const mjModel& m, std::string_view name, std::vector<std::string>& names) {
  for (int body = 1; body < m.nbody; ++body) {
    names.emplace_back(m.names + m.name_bodyadr[body]);
    if (names.back() == name) return body;
  }
  return -1;
}

/// So many numbers of two geoms, of those that start at `first`, are the same.
template <class T>
bool are_equal(const T* first, int a, int b, int count) {
  return std::equal(first + count * a, first + count * (a + 1), first + count * b);
}

bool geoms_look_alike(const mjModel& m, int a, int b) {
  return m.geom_type[a] == m.geom_type[b] && m.geom_dataid[a] == m.geom_dataid[b] &&
         m.geom_matid[a] == m.geom_matid[b] && are_equal(m.geom_size, a, b, 3) &&
         are_equal(m.geom_pos, a, b, 3) && are_equal(m.geom_quat, a, b, 4) &&
         are_equal(m.geom_rgba, a, b, 4);
}

/// The geoms of a body that are drawn.
std::vector<int> seen_geoms(const mjModel& m, int body) {
  std::vector<int> out;
  for (int i = 0; i < m.body_geomnum[body]; ++i) {
    const int geom = m.body_geomadr[body] + i;
    if (is_seen(m, geom)) out.push_back(geom);
  }
  return out;
}

}  // namespace

Surface box_surface(const Eigen::Vector3d& half) {
  Surface out;
  for (int i = 0; i < 8; ++i) {
    out.vertices.push_back(
        half.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  }
  out.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return out;
}

Surface cylinder_surface(double radius, double half_height) {
  return turned(
      {{0, -half_height}, {radius, -half_height}, {radius, half_height}, {0, half_height}});
}

SurfacePoints::SurfacePoints(Surface surface) : surface_(std::move(surface)) {
  up_to_.reserve(surface_.triangles.size());
  for (const std::array<int, 3>& triangle : surface_.triangles) {
    const Sides sides(surface_, triangle);
    up_to_.push_back(area() + 0.5 * sides.a.cross(sides.b).norm());
  }
}

SurfacePoint SurfacePoints::draw(double share, Rng& rng) const {
  const auto at = std::ranges::lower_bound(up_to_, share * area());
  const Sides sides(surface_, surface_.triangles[static_cast<std::size_t>(at - up_to_.begin())]);
  double u = rng.uniform(), w = rng.uniform();
  if (u + w > 1) u = 1 - u, w = 1 - w;
  return {sides.p + u * sides.a + w * sides.b, sides.a.cross(sides.b).normalized()};
}

void append(Surface& surface_A, const Surface& surface_B, const Pose& X_AB) {
  const int before = static_cast<int>(surface_A.vertices.size());
  for (const Eigen::Vector3d& v : surface_B.vertices) surface_A.vertices.push_back(X_AB * v);
  for (const auto& [a, b, c] : surface_B.triangles) {
    surface_A.triangles.push_back({before + a, before + b, before + c});
  }
}

Result<Surface> body_surface(const Model& model, std::string_view body) {
  const mjModel& m = *model.raw();
  std::vector<std::string> names;
  const int number = body_number(m, body, names);
  if (number < 0) {
    return fail(Errc::bad_input, text(msg::model_surface_no_body, std::string(body),
                                      did_you_mean(std::string(body), names)));
  }
  return body_surface(model, number);
}

Result<Surface> body_surface(const Model& model, int body) {
  const mjModel& m = *model.raw();
  const std::string name = m.names + m.name_bodyadr[body];
  Surface out;
  for (const int geom : seen_geoms(m, body)) {
    const std::optional<Surface> part = geom_surface(m, geom);
    if (!part) return fail(Errc::bad_input, text(msg::model_surface_flat, name));
    const mjtNum* q = m.geom_quat + 4 * geom;
    append(out, *part,
           {.p = Eigen::Map<const Eigen::Vector3d>(m.geom_pos + 3 * geom),
            .R = to_matrix(Quat(q[0], q[1], q[2], q[3]))});
  }
  if (out.triangles.empty()) {
    return fail(Errc::bad_input, text(msg::model_surface_unseen, name));
  }
  return out;
}

bool look_alike(const Model& model, std::string_view body, std::string_view other) {
  const mjModel& m = *model.raw();
  std::vector<std::string> names;
  const int a = body_number(m, body, names);
  const int b = body_number(m, other, names);
  return a >= 0 && b >= 0 &&
         std::ranges::equal(seen_geoms(m, a), seen_geoms(m, b),
                            [&](int geom, int as) { return geoms_look_alike(m, geom, as); });
}

}  // namespace mjarm
