#include <algorithm>
#include <array>
#include <numbers>

#include "mjarm/collision/cover_pairs_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm::detail {
namespace {

constexpr int kJointsProved = 3;     // between the two; for more the search is too large
constexpr int kMaxTried = 3000;      // boxes of one search
constexpr double kKeptApart = 2e-5;  // [m] at least

/// To be raised when find_meetings() gives something else for the same.
constexpr const char* kMeetings = "mjarm meetings 1\n";

using Box = std::array<double, kJointsProved>;

}  // namespace

struct MeetingProof::Search {
  const Arm& arm;
  int base;                       // joint that moves a; -1: none
  std::span<const LinkSolid> a;   // or
  const StandingSolid* standing;  // an obstacle
  std::span<const LinkSolid> b;
  std::array<double, kMaxDof> levers;  // of b
  int joints;
  int boxes = 0;

  bool is_clear(const Box& middle, const Box& half) {
    if (++boxes > kMaxTried) return false;
    double slack = 0;
    std::size_t widest = 0;
    const auto step = [&](std::size_t i) {
      return levers[static_cast<std::size_t>(base) + 1 + i] * half[i];
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(joints); ++i) {
      slack += step(i);
      if (step(i) > step(widest)) widest = i;
    }
    const double gap = least_gap(middle, slack + kKeptApart);
    if (gap <= kKeptApart) return false;
    if (gap > slack + kKeptApart) return true;
    Box child_half = half;
    child_half[widest] *= 0.5;
    for (const double side : {-1.0, 1.0}) {
      Box child = middle;
      child[widest] += side * child_half[widest];
      if (!is_clear(child, child_half)) return false;
    }
    return true;
  }

  /// [m] No more than the distance of the two; more than `enough` need not be told exactly.
  double least_gap(const Box& q, double enough) const {
    const Pose X_AB = pose(q);
    double least = std::numeric_limits<double>::infinity();
    for (const LinkSolid& other : b) {
      if (standing != nullptr) {
        least = std::min(least, gap_to_standing(other.convex, X_AB, *standing, enough));
        continue;
      }
      for (const LinkSolid& one : a) {
        const double radii = one.convex.radius() + other.convex.radius();
        const Separation apart =
            separate(one.convex, Pose(), other.convex, X_AB, {.enough = radii + enough});
        least = std::min(least, apart.gap - radii);
      }
    }
    return least;
  }

  /// Link of b seen from the link of a.
  Pose pose(const Box& q) const {
    Pose X;
    for (int i = 0; i < joints; ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(base + 1 + i)];
      const Eigen::Vector3d motion = joint.axis * q[static_cast<std::size_t>(i)];
      X = X * joint.X_PJ;
      X = X * (joint.type == JointType::hinge ? Pose{Eigen::Vector3d::Zero(), rotation_exp(motion)}
                                              : Pose{motion, Eigen::Matrix3d::Identity()});
    }
    return X;
  }
};

MeetingProof::MeetingProof(const mjModel& m, const Arm& arm, const GeomGroups& groups,
                           const GeomSolids& solids, const ContactRules& rules)
    : m_(m), arm_(arm), groups_(groups), solids_(solids), filter_(m, arm, rules), first_{0} {
  for (const GeomGroup& link : groups.links) first_.push_back(first_.back() + link.geoms.size());
}

std::vector<double> MeetingProof::longest_levers() const {
  std::vector<double> out(arm_.joints.size(), 0.0);
  for (const LinkSolid& solid : solids_.links) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], solid.levers[k]);
  }
  return out;
}

bool MeetingProof::is_allowed(const GeomGroup& a, const GeomGroup& b) const {
  const int first = a.geoms.front().geom, second = b.geoms.front().geom;
  return a.joint != b.joint && may_collide(m_, first, second) && !filter_.may_touch(first, second);
}

std::span<const LinkSolid> MeetingProof::solids_of(const MeetingPart& part) const {
  const std::size_t first = first_[part.group];
  const std::span<const LinkSolid> all(&solids_.links[first], first_[part.group + 1] - first);
  return part.geom ? all.subspan(*part.geom, 1) : all;
}

std::string MeetingProof::key() const {
  ByteKey out(kMeetings);
  out.add(arm_.joints.size());
  for (int k = 0; k < arm_.dof(); ++k) {
    const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(k)];
    const FastLimits limits = fast_limits(arm_, k);
    out.add(joint.type, joint.X_PJ, joint.axis, limits.lower, limits.upper);
  }
  for (const LinkSolid& solid : solids_.links) {
    out.add(solid.link, solid.joint, solid.levers);
    solid.convex.append_to(out);
  }
  out.add(groups_.links.size(), groups_.obstacles.size());
  for (const StandingSolid& solid : solids_.standing) {
    out.add(solid.kind, solid.X_WO, solid.ground.half, solid.ground.rows, solid.ground.cols,
            solid.ground.heights, solid.ground.bottom);
    if (solid.convex) solid.convex->append_to(out);
  }
  for (const std::vector<GeomGroup>* groups : {&groups_.links, &groups_.obstacles}) {
    for (const GeomGroup& group : *groups) {
      for (const GeomGroup& link : groups_.links) out.add(is_allowed(group, link));
    }
  }
  return out.bytes();
}

bool MeetingProof::never_meet(const MeetingPart& a, const MeetingPart& b) const {
  const int base = a.moves ? groups_.links[a.group].joint : -1;
  const int joints = groups_.links[b.group].joint - base;
  if (joints > kJointsProved) return false;
  const StandingSolid* const standing = a.moves ? nullptr : &solids_.standing[a.group];
  Search search{arm_, base, {}, standing, solids_of(b), {}, joints};
  if (a.moves) search.a = solids_of(a);
  for (const LinkSolid& solid : search.b) {
    for (std::size_t k = 0; k < kMaxDof; ++k) {
      search.levers[k] = std::max(search.levers[k], solid.levers[k]);
    }
  }
  Box middle{}, half{};
  for (int i = 0; i < joints; ++i) {
    const int joint = base + 1 + i;
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

std::optional<Meetings> find_meetings(const MeetingProof& proof, const GeomGroups& groups,
                                      const StopCheck& stop) {
  Meetings out;
  const std::size_t count = groups.links.size();
  for (std::size_t a = 0; a < count && !is_stopped(stop); ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      const GeomGroup& near = groups.links[a];
      const GeomGroup& far = groups.links[b];
      if (near.joint >= far.joint || !proof.is_allowed(near, far)) continue;
      if (proof.never_meet({true, a}, {true, b})) {
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
      const bool apart = allowed && proof.never_meet({false, k}, {true, b});
      out.apart += apart ? 1 : 0;
      if (!allowed || apart) ignored.push_back(static_cast<int>(b));
    }
    if (ignored.size() < count) out.standing.push_back({k, std::move(ignored)});
  }
  if (is_stopped(stop)) return {};
  return out;
}

}  // namespace mjarm::detail
