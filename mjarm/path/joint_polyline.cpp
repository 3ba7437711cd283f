#include "mjarm/path/joint_polyline.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/path.hpp"
#include "mjarm/path/curve_make_internal.hpp"

namespace mjarm {
namespace {

constexpr double kSame = 1e-9;  // [rad or m]

struct Leg {
  JointVec from;
  JointVec u;  // unit
  double length = 0;
};

Result<std::vector<Leg>> legs_of(std::span<const JointVec> waypoints) {
  if (waypoints.size() < 2) {
    return fail(Errc::bad_input, text(msg::path_too_few_points, waypoints.size()));
  }
  std::vector<Leg> legs;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const JointVec& q = waypoints[i];
    if (q.size() == 0 || q.size() != waypoints[0].size() || !q.allFinite()) {
      return fail(Errc::bad_input, text(msg::path_joint_waypoint, i, waypoints[0].size()));
    }
    if (i == 0) continue;
    const JointVec way = q - waypoints[i - 1];
    const double length = way.norm();
    if (!(length > kSame) || !std::isfinite(length)) {
      return fail(Errc::bad_input, text(msg::path_same_poses, i - 1, i));
    }
    legs.push_back({waypoints[i - 1], way / length, length});
  }
  return legs;
}

/// A rounded corner in the plane of its two legs: its curve as seen from `origin`, axes e0 and e1.
struct Corner {
  CurvePolynomial bend;
  JointVec origin, e0, e1;
};

std::optional<Corner> corner_of(const Leg& before, const Leg& after, double radius) {
  constexpr double kStraight = 1e-9;
  const double c = before.u.dot(after.u);
  const JointVec across = after.u - c * before.u;
  const double sine = across.norm();
  if (radius <= kSame || (c > 0 && sine < kStraight)) return std::nullopt;
  auto bend = detail::corner_bend(Eigen::Vector3d::UnitX(), {c, sine, 0}, radius);
  if (!bend) return std::nullopt;
  return Corner{std::move(*bend), after.from - radius * before.u, before.u, across / sine};
}

/// Adds `cells` samples over `length` behind the last one.
template <class At>
void add_samples(JointPath& path, double length, double step, const At& at) {
  const double start = path.s.back(), cells = std::ceil(length / step);
  for (double k = 1; k <= cells; ++k) {
    path.s.push_back(start + length * (k / cells));
    path.q.push_back(at(length * (k / cells)));
  }
}

}  // namespace

Result<JointPolyline> joint_polyline(std::span<const JointVec> waypoints,
                                     const JointPolylineOptions& options) {
  constexpr double kMaxSamples = 1e7, kCellsOfABend = 8;
  std::vector<double> blends = options.blends;
  blends.push_back(options.blend);
  for (const double blend : blends) {
    if (blend >= 0 && std::isfinite(blend)) continue;
    return fail(Errc::bad_input, text(msg::path_blend_radius, blend));
  }
  blends.pop_back();
  if (blends.empty() && waypoints.size() > 2) blends.assign(waypoints.size() - 2, options.blend);
  if (!blends.empty() && blends.size() + 2 != waypoints.size()) {
    return fail(Errc::bad_input, text(msg::path_blend_count, blends.size(), waypoints.size()));
  }
  if (!(options.step > 0)) return fail(Errc::bad_input, text(msg::path_joint_step, options.step));
  const Result<std::vector<Leg>> legs = legs_of(waypoints);
  if (!legs) return fail(legs.error());
  double whole = 0;
  for (const Leg& leg : *legs) whole += leg.length;
  if (whole / options.step + kCellsOfABend * static_cast<double>(legs->size()) > kMaxSamples) {
    return fail(Errc::bad_input, text(msg::path_joint_step, options.step));
  }

  const auto share = [&](std::size_t i) {
    return i == 0 || i + 1 == legs->size() ? (*legs)[i].length : 0.5 * (*legs)[i].length;
  };
  JointPolyline line;
  line.path.s.push_back(0);
  line.path.q.push_back(waypoints[0]);
  line.corners.push_back(0);
  double front = 0;
  for (std::size_t i = 0; i < legs->size(); ++i) {
    const Leg& leg = (*legs)[i];
    const bool last = i + 1 == legs->size();
    const double radius = last ? 0 : std::min({blends[i], share(i), share(i + 1)});
    const auto corner = last ? std::nullopt : corner_of(leg, (*legs)[i + 1], radius);
    const double back = corner ? radius : 0;
    const double straight = leg.length - front - back;
    if (straight > kSame) {
      add_samples(line.path, straight, options.step,
                  [&](double x) -> JointVec { return leg.from + (front + x) * leg.u; });
    }
    if (corner) {
      const double length = corner->bend.length();
      add_samples(line.path, length, std::min(options.step, length / kCellsOfABend),
                  [&](double x) -> JointVec {
                    const Eigen::Vector3d p = corner->bend.at(x);
                    return corner->origin + p.x() * corner->e0 + p.y() * corner->e1;
                  });
    } else {
      line.path.q.back() = waypoints[i + 1];
      if (last || (leg.u - (*legs)[i + 1].u).norm() > 1e-7) {
        line.corners.push_back(line.path.s.back());
      }
    }
    if (!last) line.radii.push_back(back);
    front = back;
  }
  return line;
}

}  // namespace mjarm
