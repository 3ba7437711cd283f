#include "mjarm/model/drawn_model.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/mesh_table_internal.hpp"

namespace mjarm {
namespace {

using Eigen::Vector3d;

std::string name_of(const mjModel& m, int type, int id) {
  const char* name = mj_id2name(&m, type, id);
  return name == nullptr ? std::string() : std::string(name);
}

std::string name_or_number(const mjModel& m, int type, int id, const char* kind) {
  std::string name = name_of(m, type, id);
  return name.empty() ? kind + (" " + std::to_string(id)) : name;
}

Pose drawn_pose(const mjtNum* pos, const mjtNum* quat) {
  return {Eigen::Map<const Vector3d>(pos),
          to_matrix(Quat(quat[0], quat[1], quat[2], quat[3]).normalized())};
}

std::optional<DrawnShape> shape_of(int type) {
  switch (type) {
    case mjGEOM_PLANE:
      return DrawnShape::plane;
    case mjGEOM_SPHERE:
      return DrawnShape::sphere;
    case mjGEOM_CAPSULE:
      return DrawnShape::capsule;
    case mjGEOM_CYLINDER:
      return DrawnShape::cylinder;
    case mjGEOM_ELLIPSOID:
      return DrawnShape::ellipsoid;
    case mjGEOM_BOX:
      return DrawnShape::box;
    case mjGEOM_MESH:
    case mjGEOM_HFIELD:
      return DrawnShape::mesh;
    default:
      return std::nullopt;
  }
}

/// How many numbers of `geom_size` mean something.
int sizes_of(DrawnShape shape) {
  switch (shape) {
    case DrawnShape::sphere:
      return 1;
    case DrawnShape::plane:
    case DrawnShape::capsule:
    case DrawnShape::cylinder:
      return 2;
    case DrawnShape::ellipsoid:
    case DrawnShape::box:
      return 3;
    case DrawnShape::mesh:
      break;
  }
  return 0;
}

/// Mean colour of the texture of a material; white where it has none that can be told.
std::array<float, 3> mean_of_texture(const mjModel& m, int material) {
  const int texture = m.mat_texid[material * mjNTEXROLE + mjTEXROLE_RGB];
  if (texture < 0 || m.tex_nchannel[texture] < 3) return {1, 1, 1};
  const auto channels = static_cast<std::size_t>(m.tex_nchannel[texture]);
  const std::size_t pixels = static_cast<std::size_t>(m.tex_height[texture]) *
                             static_cast<std::size_t>(m.tex_width[texture]);
  const mjtByte* data = m.tex_data + m.tex_adr[texture];
  double sum[3] = {0, 0, 0};
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += data[channels * i + c];
  }
  const double scale = pixels == 0 ? 0 : 1.0 / (255.0 * static_cast<double>(pixels));
  return {static_cast<float>(scale * sum[0]), static_cast<float>(scale * sum[1]),
          static_cast<float>(scale * sum[2])};
}

/// As MuJoCo colours a geom: a colour of its own counts before that of the material.
std::array<float, 4> color_of(const mjModel& m, int geom,
                              const std::vector<std::array<float, 3>>& textures) {
  std::array<float, 4> rgba = {};
  std::copy_n(m.geom_rgba + 4 * geom, 4, rgba.begin());
  const int material = m.geom_matid[geom];
  if (material < 0) return rgba;
  const bool is_default = rgba == std::array<float, 4>{0.5F, 0.5F, 0.5F, 1};
  if (is_default) std::copy_n(m.mat_rgba + 4 * material, 4, rgba.begin());
  const std::array<float, 3>& mean = textures[static_cast<std::size_t>(material)];
  for (std::size_t c = 0; c < 3; ++c) rgba[c] *= mean[c];
  return rgba;
}

DrawnMesh mesh_of(const mjModel& m, int mesh) {
  DrawnMesh out;
  const MeshTable table(m, mesh);
  out.xyz.assign(table.vertices, table.vertices + 3 * std::ptrdiff_t{table.vertex_count});
  out.corners.assign(table.faces, table.faces + 3 * std::ptrdiff_t{table.face_count});
  return out;
}

/// The upper side of a height field.
DrawnMesh height_field_of(const mjModel& m, int field) {
  DrawnMesh out;
  const int rows = m.hfield_nrow[field];
  const int columns = m.hfield_ncol[field];
  const mjtNum* size = m.hfield_size + 4 * field;
  const float* heights = m.hfield_data + m.hfield_adr[field];
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      out.xyz.push_back(static_cast<float>(size[0] * (2.0 * c / (columns - 1) - 1)));
      out.xyz.push_back(static_cast<float>(size[1] * (2.0 * r / (rows - 1) - 1)));
      out.xyz.push_back(static_cast<float>(size[2] * heights[r * columns + c]));
    }
  }
  const auto at = [columns](int r, int c) { return static_cast<std::uint32_t>(r * columns + c); };
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      out.corners.insert(out.corners.end(), {at(r, c), at(r, c + 1), at(r + 1, c + 1)});
      out.corners.insert(out.corners.end(), {at(r, c), at(r + 1, c + 1), at(r + 1, c)});
    }
  }
  return out;
}

/// Adds each mesh once, whichever geoms use it.
class Meshes {
 public:
  Meshes(const mjModel& m, std::vector<DrawnMesh>& out) : m_(m), out_(out) {}
  int place_of(int type, int data) {
    const auto [found, is_new] = places_.try_emplace({type, data}, static_cast<int>(out_.size()));
    if (is_new) {
      out_.push_back(type == mjGEOM_HFIELD ? height_field_of(m_, data) : mesh_of(m_, data));
    }
    return found->second;
  }

 private:
  const mjModel& m_;
  std::vector<DrawnMesh>& out_;
  std::map<std::pair<int, int>, int> places_;
};

void add_bodies(const mjModel& m, DrawnModel& out) {
  for (int i = 0; i < m.nbody; ++i) {
    out.bodies.push_back({.name = name_or_number(m, mjOBJ_BODY, i, "body"),
                          .p_BC = Eigen::Map<const Vector3d>(m.body_ipos + 3 * i),
                          .mass = m.body_mass[i],
                          .moves = m.body_weldid[i] != 0});
  }
}

void add_geoms(const mjModel& m, DrawnModel& out) {
  Meshes meshes(m, out.meshes);
  std::vector<std::array<float, 3>> textures;
  for (int i = 0; i < m.nmat; ++i) textures.push_back(mean_of_texture(m, i));
  for (int i = 0; i < m.ngeom; ++i) {
    const std::array<float, 4> rgba = color_of(m, i, textures);
    if (rgba[3] <= 0) continue;
    const std::optional<DrawnShape> shape = shape_of(m.geom_type[i]);
    const bool has_data = shape != DrawnShape::mesh || m.geom_dataid[i] >= 0;
    if (!shape || !has_data) {
      ++out.left_out;
      continue;
    }
    DrawnGeom geom{.id = i,
                   .body = m.geom_bodyid[i],
                   .name = name_of(m, mjOBJ_GEOM, i),
                   .group = std::clamp(m.geom_group[i], 0, mjNGROUP - 1),
                   .shape = *shape,
                   .X_BG = drawn_pose(m.geom_pos + 3 * i, m.geom_quat + 4 * i),
                   .rgba = rgba};
    std::copy_n(m.geom_size + 3 * i, sizes_of(*shape), geom.size.data());
    if (*shape == DrawnShape::mesh) geom.mesh = meshes.place_of(m.geom_type[i], m.geom_dataid[i]);
    out.geoms.push_back(std::move(geom));
  }
}

void add_cameras(const mjModel& m, DrawnModel& out) {
  for (int i = 0; i < m.ncam; ++i) {
    out.cameras.push_back({.name = name_of(m, mjOBJ_CAMERA, i),
                           .body = m.cam_bodyid[i],
                           .X_BC = drawn_pose(m.cam_pos + 3 * i, m.cam_quat + 4 * i),
                           .fovy = m.cam_fovy[i] * std::numbers::pi / 180});
  }
}

void add_joints(const mjModel& m, DrawnModel& out) {
  for (int i = 0; i < m.njnt; ++i) {
    const bool hinge = m.jnt_type[i] == mjJNT_HINGE;
    if (!hinge && m.jnt_type[i] != mjJNT_SLIDE) continue;
    DrawnJoint joint{.dof = m.jnt_dofadr[i],
                     .qpos = m.jnt_qposadr[i],
                     .name = name_or_number(m, mjOBJ_JOINT, i, "joint"),
                     .angle = hinge};
    if (m.jnt_limited[i] != 0) {
      joint.lower = m.jnt_range[2 * i];
      joint.upper = m.jnt_range[2 * i + 1];
    }
    out.joints.push_back(std::move(joint));
  }
}

}  // namespace

DrawnModel drawn_model(const Model& model) {
  DrawnModel out;
  add_bodies(*model.raw(), out);
  add_geoms(*model.raw(), out);
  add_cameras(*model.raw(), out);
  add_joints(*model.raw(), out);
  return out;
}

}  // namespace mjarm
