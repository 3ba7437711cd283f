#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/check_internal.hpp"

namespace mjarm {
namespace {

/// Heavier than any metal [kg/m^3], and lighter than any foam; of the box around a body.
constexpr double kMaxDensity = 20000;
constexpr double kLeastDensity = 5;
/// Radius of gyration over the distance of the farthest point. Above 1 no body has it; identified
/// figures of real arms reach 2.2 (the Panda's first link).
constexpr double kMaxGyration = 3;
constexpr double kLeastGyration = 0.05;
/// Nothing lighter moves an arm's joint [kg].
constexpr double kLeastMass = 1e-4;
constexpr double kLargeMesh = 5;     ///< [m] radius
constexpr double kSmallMesh = 5e-4;  ///< [m] radius
constexpr double kLongLink = 10;     ///< [m] from joint to joint

/// What can be measured of the shapes that move with a body.
struct Shapes {
  Eigen::AlignedBox3d box;  ///< in the axes of the body
  double volume = 0;        ///< [m^3] sum of the boxes around the shapes
};

void add_shapes(const mjModel* m, int body, const Pose& X_BC, Shapes& shapes) {
  for (int g = m->body_geomadr[body]; g < m->body_geomadr[body] + m->body_geomnum[body]; ++g) {
    if (m->geom_type[g] == mjGEOM_PLANE || m->geom_type[g] == mjGEOM_HFIELD) continue;
    const Pose X_BG = X_BC * pose_of(m->geom_pos + 3 * g, m->geom_quat + 4 * g);
    const Eigen::Vector3d centre(m->geom_aabb + 6 * g);
    const Eigen::Vector3d half(m->geom_aabb + 6 * g + 3);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      shapes.box.extend(X_BG * Eigen::Vector3d(centre + sign.cwiseProduct(half)));
    }
    shapes.volume += 8 * half.prod();
  }
}

/// Shapes of `body` and of all that is fixed to it.
Shapes shapes_of(const mjModel* m, int body) {
  Shapes shapes;
  add_shapes(m, body, Pose(), shapes);
  std::vector<std::pair<int, Pose>> group = {{body, Pose()}};
  for (int b = body + 1; b < m->nbody; ++b) {
    if (m->body_jntnum[b] > 0 || m->body_mocapid[b] >= 0) continue;
    const auto parent = std::find_if(group.begin(), group.end(), [&](const auto& member) {
      return member.first == m->body_parentid[b];
    });
    if (parent == group.end()) continue;
    const Pose X = parent->second * pose_of(m->body_pos + 3 * b, m->body_quat + 4 * b);
    add_shapes(m, b, X, shapes);
    group.emplace_back(b, X);
  }
  return shapes;
}

void check_density(const CheckContext& context, const Place& place, double mass,
                   const Shapes& shapes) {
  const double volume = std::min(shapes.volume, shapes.box.volume());
  if (!(volume > 1e-9)) return;
  const double density = mass / volume;
  if (density <= kMaxDensity && density >= kLeastDensity) return;
  context.add(CheckCode::mass_implausible, Grade::warning, place,
              text(density > kMaxDensity ? msg::check_too_heavy : msg::check_too_light, mass,
                   1000 * volume, density));
}

void check_gyration(const CheckContext& context, const Place& place, double radius, double size) {
  const double ratio = radius / size;
  if (ratio > kMaxGyration) {
    context.add(CheckCode::inertia_implausible, Grade::warning, place,
                text(msg::check_inertia_large, 1000 * radius, 1000 * size));
  } else if (ratio > 1) {
    context.add(CheckCode::inertia_implausible, Grade::note, place,
                text(msg::check_inertia_large, 1000 * radius, 1000 * size));
  } else if (ratio < kLeastGyration) {
    context.add(CheckCode::inertia_implausible, Grade::warning, place,
                text(msg::check_inertia_small, 1000 * radius, 1000 * size));
  }
}

void check_body(const CheckContext& context, int b) {
  const mjModel* m = context.model->raw();
  const std::string name = object_name(m, mjOBJ_BODY, b);
  const double mass = m->body_mass[b];
  const Place place = context.description.inertial(name);
  // Links of a URDF without mass are told from the text.
  const bool told = context.description.is_urdf() && !context.description.has_inertial(name);
  if (m->body_jntnum[b] > 0 && m->body_subtreemass[b] < kLeastMass && !told) {
    context.add(CheckCode::mass_implausible, Grade::warning, place,
                text(msg::check_mass_tiny, m->body_subtreemass[b]));
    return;
  }
  // Figures that MuJoCo takes from the shapes cannot disagree with them.
  if (mass < kLeastMass || !context.description.has_inertial(name)) return;
  const Shapes shapes = shapes_of(m, b);
  if (shapes.box.isEmpty()) return;
  check_density(context, place, mass, shapes);
  const Eigen::Vector3d com(m->body_ipos + 3 * b);
  const Eigen::Vector3d diagonal = shapes.box.sizes();
  const double outside = shapes.box.exteriorDistance(com);
  if (outside > std::max(0.05, diagonal.norm())) {
    context.add(CheckCode::com_outside, Grade::warning, place,
                text(msg::check_com_outside, 1000 * outside));
    return;
  }
  const Eigen::Vector3d reach =
      (shapes.box.max() - com).cwiseAbs().cwiseMax((shapes.box.min() - com).cwiseAbs());
  const double largest = Eigen::Vector3d(m->body_inertia + 3 * b).maxCoeff();
  check_gyration(context, place, std::sqrt(largest / mass), reach.norm());
}

void check_geom(const CheckContext& context, int g) {
  const mjModel* m = context.model->raw();
  const int mesh = m->geom_dataid[g];
  if (m->geom_type[g] != mjGEOM_MESH || mesh < 0) return;
  const double radius = m->geom_rbound[g];
  if (radius < kLargeMesh && radius > kSmallMesh) return;
  const std::string name = object_name(m, mjOBJ_MESH, mesh);
  const Description& description = context.description;
  const SourceNode* node = description.find("asset", "mesh", name);
  const std::string body = object_name(m, mjOBJ_BODY, m->geom_bodyid[g]);
  context.add(CheckCode::mesh_size_odd, Grade::warning,
              node != nullptr ? description.place(*node) : description.body(body),
              text(msg::check_mesh_size, name, 2 * radius));
}

}  // namespace

void check_masses(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  for (int b = 1; b < m->nbody; ++b) {
    if (m->body_weldid[b] == 0) continue;  // never moves
    check_body(context, b);
    for (int g = m->body_geomadr[b]; g < m->body_geomadr[b] + m->body_geomnum[b]; ++g) {
      check_geom(context, g);
    }
    if (const double length = Eigen::Vector3d(m->body_pos + 3 * b).norm();
        m->body_jntnum[b] > 0 && m->body_weldid[m->body_parentid[b]] != 0 && length > kLongLink) {
      const std::string name = object_name(m, mjOBJ_BODY, b);
      context.add(CheckCode::length_implausible, Grade::warning, context.description.body(name),
                  text(msg::check_length, length));
    }
  }
}

void check_world(const CheckContext& context) {
  const mjModel* m = context.model->raw();
  const Description& description = context.description;
  Place place = description.root();
  for (const SourceNode& node : description.nodes()) {
    if (node.kind() == "option") place = description.place(node);
  }
  if (m->opt.timestep > 0.01 + 1e-12) {
    context.add(CheckCode::timestep_large, Grade::warning, place,
                text(msg::check_timestep, 1000 * m->opt.timestep));
  }
  const Eigen::Vector3d g(m->opt.gravity);
  const bool weightless = g.norm() == 0 || (m->opt.disableflags & mjDSBL_GRAVITY) != 0;
  if (weightless) {
    context.add(CheckCode::gravity_odd, Grade::note, place, text(msg::check_no_gravity));
  } else if (std::abs(g.norm() - 9.8) > 0.1 || -g.z() < 0.999 * g.norm()) {
    context.add(CheckCode::gravity_odd, Grade::warning, place,
                text(msg::check_gravity, g.x(), g.y(), g.z()));
  }
}

}  // namespace mjarm
