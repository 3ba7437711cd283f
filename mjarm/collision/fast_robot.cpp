#include "mjarm/collision/fast_robot.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mjarm/collision/fast_robot_internal.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using detail::FastGroup;
using detail::FastJoint;
using detail::FastRobotData;
using detail::FastSphere;
using detail::Tilt;

static_assert(detail::kFastJoints == kMaxDof && detail::kFastGroups == kMostSphereLinks &&
              detail::kFastSpheres == kMostSpheres);

constexpr double kNothing = 1e-9;  // [m], [rad] counts as 0; the padding knows

FastJoint fast_joint(const Arm& arm, const LinkChain& chain, int i) {
  const Link& link = chain.links[i];
  FastJoint out;
  for (int k = 0; k < 3; ++k) {
    out.t[k] = std::abs(link.t[k]) < kNothing ? 0 : static_cast<float>(link.t[k]);
  }
  const bool none = std::abs(link.tilt_sin) < kNothing && link.tilt_cos > 0;
  const bool quarter = std::abs(link.tilt_cos) < kNothing && link.tilt_sin > 0;
  out.tilt = none ? Tilt::none : quarter ? Tilt::quarter : Tilt::any;
  out.tilt_cos = static_cast<float>(link.tilt_cos);
  out.tilt_sin = static_cast<float>(link.tilt_sin);
  out.offset = static_cast<float>(link.offset);
  out.slide = link.slide;
  const detail::FastLimits limits = detail::fast_limits(arm, i);
  out.lower = detail::round_up(limits.lower);
  out.upper = detail::round_down(limits.upper);
  return out;
}

/// Frame of the last of `n` links at q = 0, in the world.
Pose link_frame(const LinkChain& chain, int n) {
  Pose X{Eigen::Vector3d::Zero(),
         Eigen::AngleAxisd(std::atan2(chain.base_sin, chain.base_cos), Eigen::Vector3d::UnitZ())
             .toRotationMatrix()};
  for (int i = 0; i < n; ++i) {
    const Link& link = chain.links[i];
    Eigen::Matrix3d R_tilt = Eigen::Matrix3d::Identity();
    R_tilt.bottomRightCorner<2, 2>() << link.tilt_cos, -link.tilt_sin, link.tilt_sin, link.tilt_cos;
    const Eigen::AngleAxisd turn(link.offset, Eigen::Vector3d::UnitZ());
    X = X * Pose{{link.t[0], link.t[1], link.t[2]}, R_tilt * turn.toRotationMatrix()};
  }
  return X;
}

FastSphere fast_sphere(const Sphere& sphere, double padding) {
  const auto snapped = [](double x) {
    return std::abs(x) < kNothing ? 0.0F : static_cast<float>(x);
  };
  return {snapped(sphere.center.x()), snapped(sphere.center.y()), snapped(sphere.center.z()),
          detail::round_up(sphere.radius + padding)};
}

FastGroup fast_group(FastRobotData& data, int body, const std::vector<Sphere>& spheres,
                     double padding) {
  FastGroup group;
  group.body = body;
  group.first = static_cast<int>(data.spheres.size());
  group.count = static_cast<int>(spheres.size());
  const Sphere ball = bounding_sphere(spheres);
  group.ball = fast_sphere(ball, padding * 1.001 + 1e-9);
  double spread = 0;
  for (const Sphere& sphere : spheres) {
    data.spheres.push_back(fast_sphere(sphere, padding));
    spread = std::max(spread, (sphere.center - ball.center).norm());
  }
  group.spread = detail::round_up(spread + 1e-7);
  return group;
}

void add_groups(FastRobotData& data, const LinkChain& chain) {
  const auto bodies = detail::spheres_in_bodies(data.set, data.arm, chain);
  std::vector<int> order(bodies.size());
  std::iota(order.begin(), order.end(), 0);
  const auto joint = [&](int link) { return data.set.links[static_cast<std::size_t>(link)].joint; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return joint(a) > joint(b); });
  for (const int link : order) {
    const std::vector<Sphere>& spheres = bodies[static_cast<std::size_t>(link)];
    detail::GroupBounds bounds;
    if (joint(link) >= 0) {
      bounds = detail::group_bounds(data.arm, chain, joint(link) + 1, spheres);
    } else {
      double far = 0;
      for (const Sphere& s : spheres) far = std::max(far, s.center.norm() + s.radius);
      bounds.padding = 0x1p-24 * 80 * far;
    }
    data.padding = std::max(data.padding, bounds.padding);
    data.groups.push_back(fast_group(data, joint(link) + 1, spheres, bounds.padding));
    data.bounds.push_back(bounds);
    data.link_of_group.push_back(link);
    data.group_of_sphere.resize(data.spheres.size(), static_cast<int>(data.groups.size()) - 1);
  }
}

void add_levers(FastRobotData& data) {
  const auto lever = [&](int group, int k) {
    return detail::round_up(
        data.bounds[static_cast<std::size_t>(group)].levers[static_cast<std::size_t>(k)]);
  };
  const auto body = [&](int group) { return data.groups[static_cast<std::size_t>(group)].body; };
  for (int k = 0; k < data.arm.dof(); ++k) {
    for (int g = 0; g < static_cast<int>(data.groups.size()); ++g) {
      data.group_levers.push_back(lever(g, k));
    }
    for (const detail::FastPair& pair : data.pairs) {
      const bool between = k >= body(pair.a) && k < body(pair.b);
      data.pair_levers.push_back(between ? lever(pair.b, k) : 0);
    }
  }
}

}  // namespace

namespace detail {

std::vector<std::vector<Sphere>> spheres_in_bodies(const SphereSet& set, const Arm& arm,
                                                   const LinkChain& chain) {
  const std::vector<double> zero(static_cast<std::size_t>(arm.dof()), 0.0);
  std::vector<Pose> X_WJ(zero.size());
  fk_all(arm, zero, X_WJ);
  std::vector<std::vector<Sphere>> out;
  for (const LinkSpheres& link : set.links) {
    Pose X_BJ = link_frame(chain, link.joint + 1).inverse();
    if (link.joint >= 0) X_BJ = X_BJ * X_WJ[static_cast<std::size_t>(link.joint)];
    out.push_back(link.spheres);
    for (Sphere& sphere : out.back()) sphere.center = X_BJ * sphere.center;
  }
  return out;
}

}  // namespace detail

Result<FastRobot> FastRobot::make(const Arm& arm, const SphereSet& set) {
  const Chain chain(arm);
  if (chain.dof == 0) {
    return fail(Errc::bad_input, text(msg::collision_arm_joints, arm.dof(), kMaxDof));
  }
  if (const Result<void> fine = check_sphere_set(set, arm); !fine) return fail(fine.error());
  const LinkChain links(chain);
  auto data = std::make_shared<FastRobotData>();
  data->arm = arm;
  data->set = set;
  data->tables.dof = arm.dof();
  for (int i = 0; i < arm.dof(); ++i) data->tables.joints[i] = fast_joint(arm, links, i);
  data->R_WB = link_frame(links, 0).R;
  add_groups(*data, links);
  detail::add_pairs(*data, links);
  add_levers(*data);
  data->tables.group_count = static_cast<int>(data->groups.size());
  data->tables.pair_count = static_cast<int>(data->pairs.size());
  data->tables.every_pair_count = static_cast<int>(data->every_pair.size());
  data->tables.groups = data->groups.data();
  data->tables.spheres = data->spheres.data();
  data->tables.pairs = data->pairs.data();
  data->tables.every_pair = data->every_pair.data();
  data->tables.rows = data->rows.data();
  data->tables.partners = data->partners.data();
  return FastRobot(std::move(data));
}

int FastRobot::dof() const noexcept { return data_->tables.dof; }
const Arm& FastRobot::arm() const noexcept { return data_->arm; }
const SphereSet& FastRobot::spheres() const noexcept { return data_->set; }
double FastRobot::padding() const noexcept { return data_->padding; }

}  // namespace mjarm
