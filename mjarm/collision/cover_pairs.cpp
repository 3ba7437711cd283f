#include <algorithm>
#include <array>
#include <numbers>

#include "mjarm/collision/cover_pairs_internal.hpp"
#include "mjarm/collision/exact_capsule_box_internal.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr int kJointsProved = 3;     // between the two; for more the search is too large
constexpr int kMaxTried = 3000;      // boxes of one search
constexpr double kKeptApart = 2e-5;  // [m] at least

using Box = std::array<double, kJointsProved>;

/// The points whose hull, with a radius round it, contains the geoms: what moves no more than these
/// do not moves the geoms no more either.
LinkSpheres skeleton_of(const mjModel& m, const GeomGroup& group) {
  LinkSpheres out{group.name, group.joint, {}};
  for (const PlacedGeom& placed : group.geoms) {
    for (const Vector3d& p : solid_of_geom(m, placed).skeleton()) out.spheres.push_back({p, 0.001});
  }
  return out;
}

/// Puts a geom where the distance functions look for it.
void put_geom(mjData& d, int geom, const Pose& X) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Eigen::Map<Vector3d>(d.geom_xpos + 3 * geom) = X.p;
  Eigen::Map<Rows>(d.geom_xmat + 9 * geom) = X.R;
}

}  // namespace

struct MeetingProof::Search {
  const mjModel& m;
  mjData& d;
  const Arm& arm;
  const GeomGroup& a;
  const GeomGroup& b;
  const std::array<double, kMaxDof>& levers;
  int joints;
  int boxes = 0;

  bool is_clear(const Box& middle, const Box& half) {
    if (++boxes > kMaxTried) return false;
    double slack = 0;
    std::size_t widest = 0;
    const auto step = [&](std::size_t i) {
      return levers[static_cast<std::size_t>(a.joint) + 1 + i] * half[i];
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) {
      slack += step(i);
      if (step(i) > step(widest)) widest = i;
    }
    const double gap = distance(middle, slack + 2 * kKeptApart) - kKeptApart;
    if (gap <= 0) return false;
    if (gap > slack) return true;
    Box child_half = half;
    child_half[widest] *= 0.5;
    for (const double side : {-1.0, 1.0}) {
      Box child = middle;
      child[widest] += side * child_half[widest];
      if (!is_clear(child, child_half)) return false;
    }
    return true;
  }

  double distance(const Box& q, double max) {
    const Pose X_AB = pose(q);
    double least = max;
    for (const PlacedGeom& one : a.geoms) {
      for (const PlacedGeom& other : b.geoms) {
        GeomIds ids{one.geom, other.geom};
        put_geom(d, ids.geom1, one.X_LG);
        put_geom(d, ids.geom2, X_AB * other.X_LG);
        if (m.geom_type[ids.geom1] > m.geom_type[ids.geom2]) std::swap(ids.geom1, ids.geom2);
        least = std::min(least, geom_distance(m, &d, ids, max));
      }
    }
    return least;
  }

  /// Link of b seen from the link of a.
  Pose pose(const Box& q) const {
    Pose X;
    for (int i = 0; i < joints; ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(a.joint + 1 + i)];
      const Vector3d motion = joint.axis * q[static_cast<std::size_t>(i)];
      X = X * joint.X_PJ;
      X = X * (joint.type == JointType::hinge ? Pose{Vector3d::Zero(), rotation_exp(motion)}
                                              : Pose{motion, Eigen::Matrix3d::Identity()});
    }
    return X;
  }
};

MeetingProof::MeetingProof(const Model& model, const Arm& arm, const GeomGroups& groups,
                           const ContactRules& rules)
    : m_(*model.raw()), arm_(arm), filter_(m_, arm, rules), d_(mj_makeData(&m_)) {
  SphereSet skeletons;
  for (const GeomGroup& link : groups.links) skeletons.links.push_back(skeleton_of(m_, link));
  const LinkChain chain{Chain(arm)};
  const auto points = spheres_in_bodies(skeletons, arm, chain);
  for (std::size_t i = 0; i < points.size(); ++i) {
    levers_.push_back(group_bounds(arm, chain, groups.links[i].joint + 1, points[i]).levers);
  }
}

std::vector<double> MeetingProof::longest_levers() const {
  std::vector<double> out(arm_.joints.size(), 0.0);
  for (const auto& levers : levers_) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], levers[k]);
  }
  return out;
}

bool MeetingProof::is_allowed(const GeomGroup& a, const GeomGroup& b) const {
  const int first = a.geoms.front().geom, second = b.geoms.front().geom;
  return a.joint != b.joint && may_collide(m_, first, second) && !filter_.may_touch(first, second);
}

bool MeetingProof::never_meet(const GeomGroup& a, const GeomGroup& b, std::size_t index) {
  const int joints = b.joint - a.joint;
  if (joints > kJointsProved || !d_) return false;
  Search search{m_, *d_, arm_, a, b, levers_[index], joints};
  Box middle{}, half{};
  for (int i = 0; i < joints; ++i) {
    const int joint = a.joint + 1 + i;
    const FastLimits limits = fast_limits(arm_, joint);
    const auto k = static_cast<std::size_t>(i);
    middle[k] = 0.5 * (limits.lower + limits.upper);
    half[k] = 0.5 * (limits.upper - limits.lower);
    if (arm_.joints[static_cast<std::size_t>(joint)].type == JointType::hinge) {
      half[k] = std::min(half[k], std::numbers::pi);
    }
  }
  return search.is_clear(middle, half);
}

Meetings find_meetings(MeetingProof& proof, const GeomGroups& groups, const StopCheck& stop) {
  Meetings out;
  const std::size_t count = groups.links.size();
  for (std::size_t a = 0; a < count && !is_stopped(stop); ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      const GeomGroup& near = groups.links[a];
      const GeomGroup& far = groups.links[b];
      if (near.joint >= far.joint || !proof.is_allowed(near, far)) continue;
      if (proof.never_meet(near, far, b)) {
        ++out.apart;
      } else {
        out.pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
      }
    }
  }
  for (std::size_t k = 0; k < groups.obstacles.size() && !is_stopped(stop); ++k) {
    const GeomGroup& obstacle = groups.obstacles[k];
    std::vector<int> ignored;
    for (std::size_t b = 0; b < count; ++b) {
      const bool allowed = proof.is_allowed(obstacle, groups.links[b]);
      const bool apart = allowed && proof.never_meet(obstacle, groups.links[b], b);
      out.apart += apart ? 1 : 0;
      if (!allowed || apart) ignored.push_back(static_cast<int>(b));
    }
    if (ignored.size() < count) out.standing.push_back({k, std::move(ignored)});
  }
  return out;
}

}  // namespace mjarm::detail
