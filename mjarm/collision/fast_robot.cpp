#include "mjarm/collision/fast_robot.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/collision/fast_cache_internal.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/core/user_cache.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using detail::FastGroup;
using detail::FastJoint;
using detail::FastRobotData;
using detail::FastSphere;
using detail::Tilt;

static_assert(detail::kFastJoints == kMaxDof && detail::kFastSpheres == kMaxSpheres);

constexpr double kNothing = 1e-9;         // [m], [rad] counts as 0; the padding knows
constexpr std::ptrdiff_t kMaxOfPart = 8;  // spheres; more are cut in two

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

/// A sphere in the frame of its body, and the link of the set it belongs to.
struct LinkSphere {
  Sphere sphere;
  int link;
};

std::vector<Sphere> only_spheres(std::span<const LinkSphere> from) {
  std::vector<Sphere> out;
  for (const LinkSphere& of_link : from) out.push_back(of_link.sphere);
  return out;
}

/// Cuts spheres across where they spread most until few are left in each part.
void add_parts(FastRobotData& data, std::span<LinkSphere> from, double padding) {
  if (std::ssize(from) > kMaxOfPart) {
    Eigen::Vector3d low = from.front().sphere.center, high = low;
    for (const LinkSphere& one : from) {
      low = low.cwiseMin(one.sphere.center);
      high = high.cwiseMax(one.sphere.center);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    std::stable_sort(from.begin(), from.end(), [&](const LinkSphere& a, const LinkSphere& b) {
      return a.sphere.center[axis] < b.sphere.center[axis];
    });
    add_parts(data, from.first(from.size() / 2), padding);
    add_parts(data, from.subspan(from.size() / 2), padding);
    return;
  }
  const int first = static_cast<int>(data.spheres.size());
  for (const LinkSphere& one : from) {
    data.spheres.push_back(fast_sphere(one.sphere, padding));
    data.link_of_sphere.push_back(one.link);
  }
  data.parts.push_back({first, static_cast<int>(from.size()),
                        fast_sphere(bounding_sphere(only_spheres(from)), padding * 1.001 + 1e-9)});
}

void add_group(FastRobotData& data, int body, std::vector<LinkSphere> from, double padding) {
  FastGroup group;
  group.body = body;
  group.first = static_cast<int>(data.spheres.size());
  group.count = static_cast<int>(from.size());
  group.parts.first = static_cast<int>(data.parts.size());
  const Sphere ball = bounding_sphere(only_spheres(from));
  group.ball = fast_sphere(ball, padding * 1.001 + 1e-9);
  double spread = 0;
  for (const LinkSphere& one : from) {
    spread = std::max(spread, (one.sphere.center - ball.center).norm());
  }
  group.spread = detail::round_up(spread + 1e-7);
  add_parts(data, from, padding);
  group.parts.count = static_cast<int>(data.parts.size()) - group.parts.first;
  data.groups.push_back(group);
}

/// What one joint moves stays together, whatever links it is made of.
void add_groups(FastRobotData& data, const LinkChain& chain) {
  const auto in_bodies = detail::spheres_in_bodies(data.set, data.arm, chain);
  for (int body = data.arm.dof(); body >= 0; --body) {
    std::vector<LinkSphere> from;
    for (std::size_t l = 0; l < in_bodies.size(); ++l) {
      if (data.set.links[l].joint + 1 != body) continue;
      for (const Sphere& s : in_bodies[l]) {
        from.push_back({{s.center, s.radius + data.margins.obstacles}, static_cast<int>(l)});
      }
    }
    if (from.empty()) continue;
    detail::GroupBounds bounds;
    if (body > 0) {
      bounds = detail::group_bounds(data.arm, chain, body, only_spheres(from));
    } else {
      double far = 0;
      for (const auto& [s, link] : from) far = std::max(far, s.center.norm() + s.radius);
      bounds.padding = 0x1p-24 * 80 * far;
    }
    data.padding = std::max(data.padding, bounds.padding);
    data.bounds.push_back(bounds);
    add_group(data, body, std::move(from), bounds.padding);
    for (auto i = static_cast<std::size_t>(data.groups.back().first); i < data.spheres.size();
         ++i) {
      const FastSphere& s = data.spheres[i];
      const Sphere one{{s.x, s.y, s.z}, s.radius};
      data.levers_of_sphere.push_back(
          body > 0 ? detail::group_bounds(data.arm, chain, body, {&one, 1}).levers
                   : std::array<double, kMaxDof>{});
    }
  }
}

/// The levers of `group` for the joints between two bodies, as column `column` of a table.
struct LeverColumn {
  int column, group, from_body, to_body;
};

void set_levers(const FastRobotData& data, const LeverColumn& at, detail::LeverTable& out) {
  const auto column = static_cast<std::size_t>(at.column);
  out.from[column] = at.from_body;
  for (auto k = static_cast<std::size_t>(at.from_body); k < static_cast<std::size_t>(at.to_body);
       ++k) {
    const double lever = data.bounds[static_cast<std::size_t>(at.group)].levers[k];
    out.levers[k * out.from.size() + column] = detail::round_up(lever);
  }
}

void add_levers(FastRobotData& data) {
  const auto make = [&](std::size_t n) {
    const std::size_t whole = (n + 15) / 16 * 16;
    return detail::LeverTable{
        std::vector<float>(whole * static_cast<std::size_t>(data.arm.dof()), 0.0F),
        std::vector<int>(whole, 0)};
  };
  const auto body = [&](int group) { return data.groups[static_cast<std::size_t>(group)].body; };
  data.group_levers = make(data.groups.size());
  for (int g = 0; g < static_cast<int>(data.groups.size()); ++g) {
    set_levers(data, {g, g, 0, body(g)}, data.group_levers);
  }
  data.pair_levers = make(data.pairs.size());
  for (int p = 0; p < static_cast<int>(data.pairs.size()); ++p) {
    const detail::FastPair& pair = data.pairs[static_cast<std::size_t>(p)];
    set_levers(data, {p, pair.b, body(pair.a), body(pair.b)}, data.pair_levers);
  }
}

/// From the cache of the user where they are there. Those with margins are made for a few searches
/// and are not kept.
void add_pair_tables(FastRobotData& data, const LinkChain& chain) {
  std::optional<UserCache> cache;
  if (data.margins.obstacles == 0 && data.margins.links == 0) cache = UserCache::of_user();
  const std::string key = cache ? detail::key_of_pairs(data, chain) : std::string();
  const std::optional<std::string> known = cache ? cache->find(key) : std::nullopt;
  if (!known || !detail::read_pairs(*known, data)) {
    detail::add_pairs(data, chain);
    detail::add_apart(data, chain);
    if (cache) cache->keep(key, detail::bytes_of_pairs(data));
  }
  for (detail::FastApart& table : data.apart) table.cells = data.apart_cells.data() + table.first;
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

Result<FastRobot> FastRobot::create(const Arm& arm, const SphereSet& set,
                                    const SphereMargins& margins) {
  const Chain chain(arm);
  if (chain.dof == 0) {
    return fail(Errc::bad_input, text(msg::collision_arm_joints, arm.dof(), kMaxDof));
  }
  if (const Result<void> fine = check_sphere_set(set, arm); !fine) return fail(fine.error());
  for (const double margin : {margins.obstacles, margins.links}) {
    if (margin >= 0 && margin <= kMaxSphereMargin) continue;
    return fail(Errc::bad_input, text(msg::collision_margin, margin, kMaxSphereMargin));
  }
  const LinkChain links(chain);
  auto data = std::make_shared<FastRobotData>();
  data->arm = arm;
  data->set = set;
  data->margins = margins;
  data->tables.dof = arm.dof();
  for (int i = 0; i < arm.dof(); ++i) data->tables.joints[i] = fast_joint(arm, links, i);
  data->R_WB = link_frame(links, 0).R;
  add_groups(*data, links);
  add_pair_tables(*data, links);
  add_levers(*data);
  data->tables.group_count = static_cast<int>(data->groups.size());
  data->tables.part_count = static_cast<int>(data->parts.size());
  data->tables.pair_count = static_cast<int>(data->pairs.size());
  data->tables.every_pair_count = static_cast<int>(data->every_pair.size());
  data->tables.groups = data->groups.data();
  data->tables.parts = data->parts.data();
  data->tables.spheres = data->spheres.data();
  data->tables.link_of_sphere = data->link_of_sphere.data();
  data->tables.pairs = data->pairs.data();
  data->tables.every_pair = data->every_pair.data();
  data->tables.apart = data->apart.data();
  data->tables.rows = data->rows.data();
  data->tables.part_pairs = data->part_pairs.data();
  data->tables.partners = data->partners.data();
  return FastRobot(std::move(data));
}

int FastRobot::dof() const noexcept { return data_->tables.dof; }
const Arm& FastRobot::arm() const noexcept { return data_->arm; }
const SphereSet& FastRobot::spheres() const noexcept { return data_->set; }
const SphereMargins& FastRobot::margins() const noexcept { return data_->margins; }
double FastRobot::padding() const noexcept { return data_->padding; }

}  // namespace mjarm
