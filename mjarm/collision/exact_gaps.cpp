#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/collision/exact_gaps_internal.hpp"

namespace mjarm::detail {
namespace {

/// The body that `body` is welded to, so that bodies without a joint between them are one.
int weld_of(const mjModel& m, int body) { return m.body_weldid[body]; }

int parent_weld_of(const mjModel& m, int weld) { return weld_of(m, m.body_parentid[weld]); }

bool is_excluded(const mjModel& m, int body1, int body2) {
  const int signature = (std::min(body1, body2) << 16) + std::max(body1, body2);
  const int swapped = (std::max(body1, body2) << 16) + std::min(body1, body2);
  const int* const first = m.exclude_signature;
  return std::any_of(first, first + m.nexclude,
                     [&](int value) { return value == signature || value == swapped; });
}

bool is_explicit_pair(const mjModel& m, int geom1, int geom2) {
  for (int i = 0; i < static_cast<int>(m.npair); ++i) {
    const int a = m.pair_geom1[i];
    const int b = m.pair_geom2[i];
    if ((a == geom1 && b == geom2) || (a == geom2 && b == geom1)) return true;
  }
  return false;
}

/// From its lowest point over the plane.
std::optional<GeomGap> plane_cylinder_gap(const mjModel& m, mjData* d, GeomIds ids, double margin) {
  using Rows = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  const Eigen::Vector3d normal = Rows(d->geom_xmat + 9 * ids.geom1).col(2);
  const Eigen::Vector3d axis = Rows(d->geom_xmat + 9 * ids.geom2).col(2);
  const Eigen::Map<const Eigen::Vector3d> plane(d->geom_xpos + 3 * ids.geom1);
  const Eigen::Map<const Eigen::Vector3d> center(d->geom_xpos + 3 * ids.geom2);
  const double radius = m.geom_size[3 * ids.geom2], half = m.geom_size[3 * ids.geom2 + 1];
  const double along = normal.dot(axis);
  const Eigen::Vector3d side = normal - along * axis;
  const Eigen::Vector3d lowest =
      center - (along < 0 ? -half : half) * axis - radius / std::max(side.norm(), 1e-12) * side;
  const double distance = normal.dot(lowest - plane);
  if (distance >= margin) return std::nullopt;
  return GeomGap{distance, lowest - 0.5 * distance * normal, normal};
}

}  // namespace

bool is_measured_here(const mjModel& m, int geom1, int geom2) {
  const int type1 = m.geom_type[geom1], type2 = m.geom_type[geom2];
  return (type1 == mjGEOM_CAPSULE && type2 == mjGEOM_BOX) ||
         (type1 == mjGEOM_PLANE && type2 == mjGEOM_CYLINDER);
}

bool may_collide(const mjModel& m, int geom1, int geom2) {
  if (is_explicit_pair(m, geom1, geom2)) return true;
  const bool compatible = (m.geom_contype[geom1] & m.geom_conaffinity[geom2]) != 0 ||
                          (m.geom_contype[geom2] & m.geom_conaffinity[geom1]) != 0;
  if (!compatible) return false;
  const int body1 = m.geom_bodyid[geom1];
  const int body2 = m.geom_bodyid[geom2];
  if (is_excluded(m, body1, body2)) return false;
  const int weld1 = weld_of(m, body1);
  const int weld2 = weld_of(m, body2);
  if (weld1 == weld2) return false;
  const bool filters_parents = (m.opt.disableflags & mjDSBL_FILTERPARENT) == 0;
  const bool family = parent_weld_of(m, weld1) == weld2 || parent_weld_of(m, weld2) == weld1;
  return !(filters_parents && weld1 != 0 && weld2 != 0 && family);
}

std::vector<GeomIds> pairs_measured_here(const mjModel& m, const std::vector<bool>& moves) {
  std::vector<GeomIds> out;
  const auto moving = [&](int geom) {
    return moves[static_cast<std::size_t>(m.geom_bodyid[geom])];
  };
  for (int i = 0; i < static_cast<int>(m.ngeom); ++i) {
    if (m.geom_type[i] != mjGEOM_CAPSULE && m.geom_type[i] != mjGEOM_PLANE) continue;
    for (int j = 0; j < static_cast<int>(m.ngeom); ++j) {
      const bool wanted = is_measured_here(m, i, j) && (moving(i) || moving(j));
      if (wanted && may_collide(m, i, j)) out.push_back({i, j});
    }
  }
  return out;
}

std::optional<GeomGap> gap_measured_here(const mjModel& m, mjData* d, GeomIds ids, double margin) {
  if (m.geom_type[ids.geom1] == mjGEOM_PLANE) return plane_cylinder_gap(m, d, ids, margin);
  const Eigen::Map<const Eigen::Vector3d> p1(d->geom_xpos + 3 * ids.geom1);
  const Eigen::Map<const Eigen::Vector3d> p2(d->geom_xpos + 3 * ids.geom2);
  if ((p1 - p2).norm() > m.geom_rbound[ids.geom1] + m.geom_rbound[ids.geom2] + margin) {
    return std::nullopt;
  }
  // The entry for a cylinder and a box is the convex collider, which takes any convex shape. With a
  // margin it may be off by centimetres.
  std::array<mjPreContact, mjMAXCONPAIR> found;
  const int count =
      mjCOLLISIONFUNC[mjGEOM_CYLINDER][mjGEOM_BOX](&m, d, found.data(), ids.geom1, ids.geom2, 0);
  if (count > 0) {
    const mjPreContact& nearest =
        *std::min_element(found.begin(), found.begin() + count,
                          [](const auto& a, const auto& b) { return a.dist < b.dist; });
    return GeomGap{nearest.dist, Eigen::Map<const Eigen::Vector3d>(nearest.pos),
                   Eigen::Map<const Eigen::Vector3d>(nearest.normal)};
  }
  if (margin <= 0) return std::nullopt;
  std::array<mjtNum, 6> segment{};
  const double distance = mj_geomDistance(&m, d, ids.geom1, ids.geom2, margin, segment.data());
  if (distance >= margin) return std::nullopt;
  const Eigen::Map<const Eigen::Vector3d> from(segment.data()), to(segment.data() + 3);
  return GeomGap{distance, 0.5 * (from + to), (to - from).normalized()};
}

double geom_distance(const mjModel& m, mjData* d, GeomIds ids, double max) {
  if (!is_measured_here(m, ids.geom1, ids.geom2)) {
    return mj_geomDistance(&m, d, ids.geom1, ids.geom2, max, nullptr);
  }
  const std::optional<GeomGap> gap = gap_measured_here(m, d, ids, max);
  return gap ? gap->distance : max;
}

}  // namespace mjarm::detail
