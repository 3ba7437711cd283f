#include "mjarm/collision/fast_check.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "mjarm/collision/fast_access_internal.hpp"
#include "mjarm/collision/fast_clearance_internal.hpp"
#include "mjarm/collision/fast_kernel_internal.hpp"
#include "mjarm/collision/solid_scene_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace detail {

const FastKernels kFastBaseline = {kFloats, collide_block, cover_block, bound_motion,
                                   clearances_of_block};

}  // namespace detail

namespace {

constexpr int kMaxLanes = 16;
constexpr double kFarther = 0.05;  // [m]

const detail::FastKernels& fast_kernels([[maybe_unused]] SimdLevel level) {
#if defined(__x86_64__)
  switch (std::min(level, simd_level())) {
    case SimdLevel::avx512:
      return detail::kFastAvx512;
    case SimdLevel::avx2:
      return detail::kFastAvx2;
    default:
      break;
  }
#endif
  return detail::kFastBaseline;
}

/// Some configurations, joint by joint, as the kernels take them; unused lanes repeat the last.
struct LaneInput {
  alignas(64) float q[kMaxDof * kMaxLanes];

  LaneInput(const double* rows, std::size_t count, std::size_t dof, std::size_t width) {
    for (std::size_t i = 0; i < dof; ++i) {
      for (std::size_t k = 0; k < width; ++k) {
        q[i * width + k] = static_cast<float>(rows[std::min(k, count - 1) * dof + i]);
      }
    }
  }
};

std::optional<FastChecker::FixedOverlap> find_fixed_overlap(const SphereSet& set,
                                                            const Obstacles& obstacles) {
  for (std::size_t l = 0; l < set.links.size(); ++l) {
    if (set.links[l].joint >= 0) continue;
    for (const Sphere& sphere : set.links[l].spheres) {
      const auto overlaps = [&](const auto& obstacle) {
        return distance(obstacle, sphere.center) < sphere.radius;
      };
      const auto counts = [&](const Obstacle& solid) {
        const auto index = static_cast<int>(&solid - obstacles.solids.data());
        const IgnoredPair pair{static_cast<int>(l), index};
        const auto& ignored = obstacles.ignored;
        return overlaps(solid) && std::find(ignored.begin(), ignored.end(), pair) == ignored.end();
      };
      const std::vector<Obstacle>& solids = obstacles.solids;
      const std::vector<PointCloud>& clouds = obstacles.clouds;
      const auto solid = std::find_if(solids.begin(), solids.end(), counts);
      const auto cloud = std::find_if(clouds.begin(), clouds.end(), overlaps);
      if (solid == solids.end() && cloud == clouds.end()) continue;
      const auto index = solid != solids.end() ? solid - solids.begin()
                                               : cloud - clouds.begin() + std::ssize(solids);
      return FastChecker::FixedOverlap{static_cast<int>(l), static_cast<int>(index)};
    }
  }
  return std::nullopt;
}

}  // namespace

FastChecker::FastChecker(FastRobot robot, const Obstacles& obstacles, SimdLevel level)
    : robot_(std::move(robot)),
      world_(std::make_shared<detail::FastWorld>(detail::FastAccess::data(robot_), obstacles)),
      kernels_(&fast_kernels(level)),
      fixed_overlap_(find_fixed_overlap(robot_.spheres(), obstacles)) {}

Result<FastChecker> FastChecker::create(FastRobot robot, const Obstacles& obstacles,
                                        SimdLevel level) {
  if (const Result<void> fine =
          check_obstacles(obstacles, static_cast<int>(robot.spheres().links.size()));
      !fine) {
    return fail(fine.error());
  }
  return FastChecker(std::move(robot), obstacles, level);
}

FastChecker FastChecker::looking_closer(std::shared_ptr<const detail::SolidScene> solids,
                                        std::optional<SphereMargins> margins) const {
  FastChecker out = *this;
  out.solids_ = std::move(solids);
  out.closer_ = margins.value_or(robot_.margins());
  return out;
}

int FastChecker::width() const noexcept { return kernels_->width; }

std::uint32_t FastChecker::collide(std::span<const double> q, std::size_t first,
                                   bool any) const noexcept {
  if (fixed_overlap_) return ~std::uint32_t{0};
  const auto dof = static_cast<std::size_t>(robot_.dof());
  const std::size_t count =
      std::min(static_cast<std::size_t>(kernels_->width), q.size() / dof - first);
  const detail::FastRows rows{q.data() + first * dof, static_cast<int>(count)};
  const std::uint32_t hit = kernels_->collide(detail::FastAccess::data(robot_).tables,
                                              world_->tables, rows, any && !solids_);
  if (hit == 0 || !solids_) return hit;
  const std::uint32_t lanes = (std::uint32_t{1} << count) - 1;
  return look_closer(q.subspan(first * dof, count * dof), hit & lanes, any);
}

std::uint32_t FastChecker::look_closer(std::span<const double> rows, std::uint32_t hit,
                                       bool any) const noexcept {
  const auto dof = static_cast<std::size_t>(robot_.dof());
  std::uint32_t out = 0;
  for (std::uint32_t left = hit; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(__builtin_ctz(left));
    const std::span<const double> q = rows.subspan(lane * dof, dof);
    const bool free =
        within_limits(robot_.arm(), q, -detail::kLimitSlack) && solids_->is_free(q, closer_);
    if (free) continue;
    out |= std::uint32_t{1} << lane;
    if (any) break;
  }
  return out;
}

void FastChecker::check(std::span<const double> q, std::span<std::uint8_t> free) const noexcept {
  const auto width = static_cast<std::size_t>(kernels_->width);
  assert(q.size() == free.size() * static_cast<std::size_t>(robot_.dof()));
  for (std::size_t first = 0; first < free.size(); first += width) {
    const std::uint32_t hit = collide(q, first, false);
    for (std::size_t k = 0; k < std::min(width, free.size() - first); ++k) {
      free[first + k] = static_cast<std::uint8_t>(1 - ((hit >> k) & 1));
    }
  }
}

bool FastChecker::is_free(std::span<const double> q) const noexcept { return all_free(q); }

bool FastChecker::all_free(std::span<const double> q) const noexcept {
  const auto width = static_cast<std::size_t>(kernels_->width);
  const std::size_t rows = q.size() / static_cast<std::size_t>(robot_.dof());
  for (std::size_t first = 0; first < rows; first += width) {
    if (collide(q, first, true) != 0) return false;
  }
  return true;
}

SphereClearance FastChecker::clearance_of(const detail::FastNearest& from) const noexcept {
  const detail::FastRobotData& data = detail::FastAccess::data(robot_);
  const auto link_of = [&](int sphere) {
    return sphere < 0 ? -1 : data.link_of_sphere[static_cast<std::size_t>(sphere)];
  };
  return {from.distance, link_of(from.sphere), from.obstacle, link_of(from.other)};
}

SphereClearance FastChecker::closer_clearance(std::span<const double> q,
                                              double max) const noexcept {
  const auto found = solids_->clearance(q, max, closer_);
  return {found.distance, found.pair.link, found.pair.obstacle, found.pair.other_link};
}

void FastChecker::clearances(std::span<const double> q, std::span<SphereClearance> out,
                             double max) const noexcept {
  const auto dof = static_cast<std::size_t>(robot_.dof());
  assert(q.size() == out.size() * dof);
  if (!solids_) return sphere_clearances(q, out, max);
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] = closer_clearance(q.subspan(k * dof, dof), max);
  }
}

void FastChecker::sphere_clearances(std::span<const double> q, std::span<SphereClearance> out,
                                    double max) const noexcept {
  const auto dof = static_cast<std::size_t>(robot_.dof());
  const auto width = static_cast<std::size_t>(kernels_->width);
  for (std::size_t first = 0; first < out.size(); first += width) {
    const std::size_t count = std::min(width, out.size() - first);
    const LaneInput input(q.data() + first * dof, count, dof, width);
    detail::FastNearest nearest[kMaxLanes];
    kernels_->clearances(detail::FastAccess::data(robot_).tables, world_->tables, input.q,
                         static_cast<float>(max), false, nearest);
    for (std::size_t k = 0; k < count; ++k) out[first + k] = clearance_of(nearest[k]);
  }
}

/// Spheres tell a lower bound of each, so that only those that they call near are looked at closer.
FastChecker::LeastClearance FastChecker::least_looking_closer(std::span<const double> q) const {
  const auto dof = static_cast<std::size_t>(robot_.dof());
  std::vector<SphereClearance> bounds(q.size() / dof);
  sphere_clearances(q, bounds, detail::kMaxClearance);
  std::vector<std::size_t> order(bounds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return bounds[k].distance; });
  LeastClearance out;
  out.nearest.distance = detail::kMaxClearance;
  for (const std::size_t k : order) {
    if (bounds[k].distance >= out.nearest.distance) break;
    // Solids are little farther away than the spheres round them.
    const std::span<const double> row = q.subspan(k * dof, dof);
    const double max = std::min(out.nearest.distance, 2 * std::abs(bounds[k].distance) + kFarther);
    SphereClearance found = closer_clearance(row, max);
    if (found.link < 0) found = closer_clearance(row, out.nearest.distance);
    if (found.distance < out.nearest.distance) out = {found, k};
  }
  return out;
}

FastChecker::LeastClearance FastChecker::least_clearance(std::span<const double> q) const {
  if (solids_) return least_looking_closer(q);
  const auto dof = static_cast<std::size_t>(robot_.dof());
  const auto width = static_cast<std::size_t>(kernels_->width);
  const std::size_t rows = q.size() / dof;
  LeastClearance out;
  out.nearest.distance = detail::kMaxClearance;
  for (std::size_t first = 0; first < rows; first += width) {
    const std::size_t count = std::min(width, rows - first);
    const LaneInput input(q.data() + first * dof, count, dof, width);
    detail::FastNearest nearest[kMaxLanes];
    kernels_->clearances(detail::FastAccess::data(robot_).tables, world_->tables, input.q,
                         static_cast<float>(out.nearest.distance), true, nearest);
    for (std::size_t k = 0; k < width; ++k) {
      if (nearest[k].sphere < 0) continue;
      out = {clearance_of(nearest[k]), first + std::min(k, count - 1)};
    }
  }
  return out;
}

SphereClearance FastChecker::clearance(std::span<const double> q) const noexcept {
  SphereClearance out;
  clearances(q, {&out, 1});
  return out;
}

}  // namespace mjarm
