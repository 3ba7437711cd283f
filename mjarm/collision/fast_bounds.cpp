#include <algorithm>
#include <cmath>
#include <numbers>

#include "mjarm/collision/fast_robot_internal.hpp"
#include "mjarm/core/simd/functions.hpp"

/// What a link can do at most, whatever the joints do: how far it reaches, how fast a joint moves
/// it, and how wrong single precision can be about its place.
namespace mjarm::detail {
namespace {

constexpr double kEndlessTurn = 4 * std::numbers::pi;  // [rad]
constexpr double kEndlessSlide = 10;                   // [m]
constexpr double kUnit = 0x1p-24;                      // rounding error of a float, relative

/// Where a point can be, seen from the frame of a joint: between two heights, at most so far from
/// the axis, and at most so far from the origin. Turning about the axis changes none of them.
struct Hull {
  double low, high, radial, norm;

  explicit Hull(const Eigen::Vector3d& p)
      : low(p.z()), high(p.z()), radial(std::hypot(p.x(), p.y())), norm(p.norm()) {}

  double tallest() const { return std::max(std::abs(low), std::abs(high)); }

  void slide(const FastLimits& limits) {
    low += limits.lower;
    high += limits.upper;
    norm = std::hypot(radial, tallest());
  }

  /// The same, seen from the frame of the joint before.
  void carry(const Link& link) {
    const double t = std::hypot(link.t[0], link.t[1], link.t[2]);
    const double tip_low = link.tilt_cos * low, tip_high = link.tilt_cos * high;
    const double swing = std::abs(link.tilt_sin) * radial;
    const double shift = std::max(std::hypot(link.t[0], link.t[1] - link.tilt_sin * low),
                                  std::hypot(link.t[0], link.t[1] - link.tilt_sin * high));
    low = link.t[2] + std::min(tip_low, tip_high) - swing;
    high = link.t[2] + std::max(tip_low, tip_high) + swing;
    norm += t;
    radial = std::min(radial + shift, norm);
    norm = std::min(norm, std::hypot(radial, tallest()));
  }
};

/// Error of the angle (or travel) of a joint in single precision, its sine included, as far as it
/// moves a point at distance 1.
double joint_error(const Arm& arm, const LinkChain& chain, int k) {
  const FastLimits limits = fast_limits(arm, k);
  const double max = std::max(std::abs(limits.lower), std::abs(limits.upper));
  const double rounding = 6 * kUnit * (max + std::abs(chain.links[k].offset));
  return rounding + (chain.links[k].slide ? 0 : std::numbers::sqrt2 * simd::kTrigError);
}

/// A frame after m joints is off by at most 17 m units (two turns of two columns, each entry three
/// roundings, and the rounding of the tilt), its origin by 22 m units of the way there; the place
/// of a sphere, its way into the frame of a solid and the test add less than 40 units.
double padding_of(const Arm& arm, const LinkChain& chain, int body, const GroupBounds& bounds,
                  double way) {
  double error = kUnit * way * (24 * body + 40) + 2e-9 * way * body;
  for (int k = 0; k < body; ++k) error += bounds.levers[k] * joint_error(arm, chain, k);
  return 1.2 * error;
}

}  // namespace

FastLimits fast_limits(const Arm& arm, int joint) {
  const bool slide = arm.joints[static_cast<std::size_t>(joint)].type == JointType::slide;
  const double max = slide ? kEndlessSlide : kEndlessTurn;
  return {std::max(arm.limits.lower[joint] - kLimitSlack, -max),
          std::min(arm.limits.upper[joint] + kLimitSlack, max)};
}

GroupBounds group_bounds(const Arm& arm, const LinkChain& chain, int body,
                         std::span<const Sphere> spheres) {
  GroupBounds out;
  double way = 0;
  std::vector<Hull> hulls;
  for (const Sphere& sphere : spheres) hulls.emplace_back(sphere.center);
  for (int k = body - 1; k >= 0; --k) {
    const Link& link = chain.links[k];
    for (Hull& hull : hulls) {
      out.levers[k] = std::max(out.levers[k], link.slide ? 1.0 : hull.radial);
      if (link.slide) hull.slide(fast_limits(arm, k));
      if (k > 0) hull.carry(link);
    }
  }
  // The hulls now are seen from the first joint; their middle is on its axis.
  double low = hulls.front().low, high = low;
  for (const Hull& hull : hulls) {
    low = std::min(low, hull.low);
    high = std::max(high, hull.high);
  }
  const double middle = 0.5 * (low + high);
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    const Hull& hull = hulls[i];
    const double height = std::max(hull.high - middle, middle - hull.low);
    const double far = std::min(std::hypot(hull.radial, height), hull.norm + std::abs(middle));
    out.reach = std::max(out.reach, far + spheres[i].radius);
    way = std::max(way, hull.norm + spheres[i].radius);
  }
  const Link& first = chain.links[0];
  const Eigen::Vector3d t(first.t[0], first.t[1], first.t[2]);
  const Eigen::Vector3d tip = t + middle * Eigen::Vector3d(0, -first.tilt_sin, first.tilt_cos);
  out.reach_center_W = {chain.base_cos * tip.x() - chain.base_sin * tip.y(),
                        chain.base_sin * tip.x() + chain.base_cos * tip.y(), tip.z()};
  out.padding = padding_of(arm, chain, body, out, way + t.norm());
  return out;
}

}  // namespace mjarm::detail
