#include <algorithm>
#include <cmath>

#include "mjarm/collision/fast_crowd_internal.hpp"
#include "mjarm/collision/mesh_internal.hpp"

namespace mjarm::detail {
namespace {

Eigen::Vector3d vector_of(const float* from) { return {from[0], from[1], from[2]}; }

FastBounds outward(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  FastBounds out;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = round_down(low[k]);
    out.high[k] = round_up(high[k]);
  }
  return out;
}

}  // namespace

void CrowdBuilder::add(const FastItem& item) {
  const FastBounds bounds = bounds_of(item);
  const Eigen::Vector3d nearest =
      space_.middle_F.cwiseMax(bounds.low.cast<double>()).cwiseMin(bounds.high.cast<double>());
  if ((nearest - space_.middle_F).norm() > space_.reach + kMaxClearance) return;
  items_.push_back(item);
  bounds_.push_back(bounds);
}

void CrowdBuilder::add(const Obstacle& solid, int id) {
  const Pose X_FO = Pose{Eigen::Vector3d::Zero(), space_.R_WF[0].transpose()} * solid.X_WO;
  if (const auto* polytope = std::get_if<PolytopeShape>(&solid.shape)) {
    add_polytope(*polytope, X_FO, id);
  } else if (const auto* mesh = std::get_if<MeshShape>(&solid.shape)) {
    add_mesh(*mesh, X_FO, id);
  }
}

/// Planes move inwards by nothing: what rounding does is taken off their offsets.
void CrowdBuilder::add_polytope(const PolytopeShape& shape, const Pose& X_FO, int id) {
  FastPolytope out;
  out.first = static_cast<int>(out_.planes.size());
  const double size = X_FO.p.norm() + space_.middle_F.norm() + space_.reach;
  const auto add_plane = [&](const Eigen::Vector3d& n, double d) {
    const Eigen::Vector3d n_F = X_FO.R * n;
    const double d_F = d + n_F.dot(X_FO.p);
    FastPlane plane;
    for (int k = 0; k < 3; ++k) plane.n[k] = static_cast<float>(n_F[k]);
    plane.d = round_up(d_F + 0x1p-21 * (size + std::abs(d_F)));
    out_.planes.push_back(plane);
  };
  for (const Eigen::Vector4d& plane : shape.planes) add_plane(plane.head<3>(), plane.w());
  for (int k = 0; k < 3; ++k) {
    add_plane(Eigen::Vector3d::Unit(k), shape.high[k]);
    add_plane(-Eigen::Vector3d::Unit(k), -shape.low[k]);
  }
  out.count = static_cast<int>(out_.planes.size()) - out.first;
  out_.polytopes.push_back(out);
  const int index = static_cast<int>(out_.polytopes.size()) - 1;
  const Eigen::Vector3d center = X_FO * (0.5 * (shape.low + shape.high));
  const Eigen::Vector3d half = X_FO.R.cwiseAbs() * (0.5 * (shape.high - shape.low)) +
                               Eigen::Vector3d::Constant(0x1p-20 * size);
  polytope_bounds_.push_back(outward(center - half, center + half));
  add({FastKind::polytope, 0, index, id});
}

void CrowdBuilder::add_mesh(const MeshShape& shape, const Pose& X_FO, int id) {
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3d& vertex : shape.vertices) vertices.push_back(X_FO * vertex);
  SolidFill fill;
  if (shape.solid) fill = fill_solid(vertices, shape.faces, space_);
  for (const auto& [a, b, c] : shape.faces) {
    const auto corner = [&](int i) { return vertices[static_cast<std::size_t>(i)]; };
    out_.triangles.push_back(fast_triangle({corner(a), corner(b), corner(c)}, fill.thickness));
    add({FastKind::triangle, 0, static_cast<int>(out_.triangles.size()) - 1, id});
  }
  for (const SolidFill::Cube& cube : fill.cubes) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(cube.half);
    const FastBounds bounds = outward(cube.center - half, cube.center + half);
    FastBox box;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = bounds.low[k];
      box.high[k] = bounds.high[k];
    }
    out_.boxes.push_back(box);
    out_.box_ids.push_back(id);
    add({FastKind::box, 0, static_cast<int>(out_.boxes.size()) - 1, id});
  }
}

void CrowdBuilder::build(std::span<const PointCloud> clouds, int first_id) {
  std::vector<Eigen::Vector3f> places;
  for (const FastBounds& bounds : bounds_) places.push_back(0.5F * (bounds.low + bounds.high));
  std::vector<FastBounds> leaves;
  for (const int i : curve_order(places)) {
    out_.items.push_back(items_[static_cast<std::size_t>(i)]);
    leaves.push_back(bounds_[static_cast<std::size_t>(i)]);
  }
  out_.crowd.build(leaves);
  add_clouds(clouds, space_.R_WF[0], space_.middle_F, space_.reach + kMaxClearance, first_id, out_);
  if (!items_.empty() || !out_.point_ids.empty()) build_grid();
}

void CrowdBuilder::build_grid() {
  out_.grid = {space_.middle_F, space_.reach, items_.size() + out_.point_ids.size()};
  for (std::size_t i = 0; i < items_.size(); ++i) {
    out_.grid.mark(bounds_[i], [&](const Eigen::Vector3d& p_F) {
      return gap_of(items_[i], p_F) <= out_.grid.cell_radius();
    });
  }
  out_.grid.finish(mark_clouds(out_));
}

/// Of a leaf, in frame 0.
FastBounds CrowdBuilder::bounds_of(const FastItem& item) const {
  const auto i = static_cast<std::size_t>(item.index);
  Eigen::Vector3d low, high;
  switch (item.kind) {
    case FastKind::polytope:
      return polytope_bounds_[i];
    case FastKind::triangle: {
      const FastTriangle& triangle = out_.triangles[i];
      low = high = vector_of(triangle.corner[0]);
      for (const auto& corner : triangle.corner) {
        low = low.cwiseMin(vector_of(corner));
        high = high.cwiseMax(vector_of(corner));
      }
      const Eigen::Vector3d round = Eigen::Vector3d::Constant(triangle.round);
      return outward(low - round, high + round);
    }
    case FastKind::cylinder: {
      const FastCylinder& cylinder = out_.cylinders[i];
      Eigen::Vector3d half = Eigen::Vector3d::Constant(cylinder.radius);
      half[cylinder.axis] = cylinder.half;
      low = vector_of(cylinder.center) - half;
      high = vector_of(cylinder.center) + half;
      break;
    }
    case FastKind::box: {
      const FastBox& box = out_.boxes[i];
      low = vector_of(box.low) - Eigen::Vector3d::Constant(box.round);
      high = vector_of(box.high) + Eigen::Vector3d::Constant(box.round);
      break;
    }
  }
  const Eigen::Matrix3d R =
      space_.R_WF[0].transpose() * space_.R_WF[static_cast<std::size_t>(item.frame)];
  const Eigen::Vector3d center = R * (0.5 * (low + high));
  const Eigen::Vector3d half = R.cwiseAbs() * (0.5 * (high - low)) * (1 + 1e-12);
  return outward(center - half, center + half);
}

/// [m] from a point in frame 0 to a leaf, or less.
double CrowdBuilder::gap_of(const FastItem& item, const Eigen::Vector3d& p_F) const {
  const auto i = static_cast<std::size_t>(item.index);
  if (item.kind == FastKind::triangle) {
    const auto& [a, b, c] = out_.triangles[i].corner;
    return distance_to_triangle(p_F, vector_of(a), vector_of(b), vector_of(c)) -
           out_.triangles[i].round;
  }
  if (item.kind == FastKind::polytope) {
    const FastPolytope& polytope = out_.polytopes[i];
    double gap = 0;
    for (int k = polytope.first; k < polytope.first + polytope.count; ++k) {
      const FastPlane& plane = out_.planes[static_cast<std::size_t>(k)];
      gap = std::max(gap, vector_of(plane.n).dot(p_F) - plane.d);
    }
    return gap;
  }
  const Eigen::Matrix3d& R_WF = space_.R_WF[static_cast<std::size_t>(item.frame)];
  const Eigen::Vector3d p = R_WF.transpose() * (space_.R_WF[0] * p_F);
  if (item.kind == FastKind::box) {
    const FastBox& box = out_.boxes[i];
    const Eigen::Vector3d inside = p.cwiseMax(vector_of(box.low)).cwiseMin(vector_of(box.high));
    return (p - inside).norm() - box.round;
  }
  const FastCylinder& cylinder = out_.cylinders[i];
  Eigen::Vector3d d = p - vector_of(cylinder.center);
  const double along = std::max(std::abs(d[cylinder.axis]) - cylinder.half, 0.0);
  d[cylinder.axis] = 0;
  return std::hypot(std::max(d.norm() - cylinder.radius, 0.0), along);
}

}  // namespace mjarm::detail
