#include "mjarm/collision/fast_check.hpp"

#include <algorithm>
#include <cassert>

#include "mjarm/collision/fast_access_internal.hpp"
#include "mjarm/collision/fast_clearance_internal.hpp"
#include "mjarm/collision/fast_kernel_internal.hpp"

namespace mjarm {
namespace detail {

const FastKernels kFastBaseline = {kFloats, collide_block, cover_block, bound_motion,
                                   clearances_of_block};

}  // namespace detail

namespace {

constexpr int kMaxLanes = 16;

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

int FastChecker::width() const noexcept { return kernels_->width; }

std::uint32_t FastChecker::collide(std::span<const double> q, std::size_t first,
                                   bool any) const noexcept {
  if (fixed_overlap_) return ~std::uint32_t{0};
  const auto dof = static_cast<std::size_t>(robot_.dof());
  const std::size_t count =
      std::min(static_cast<std::size_t>(kernels_->width), q.size() / dof - first);
  const detail::FastRows rows{q.data() + first * dof, static_cast<int>(count)};
  return kernels_->collide(detail::FastAccess::data(robot_).tables, world_->tables, rows, any);
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

void FastChecker::clearances(std::span<const double> q,
                             std::span<SphereClearance> out) const noexcept {
  const auto dof = static_cast<std::size_t>(robot_.dof());
  const auto width = static_cast<std::size_t>(kernels_->width);
  assert(q.size() == out.size() * dof);
  for (std::size_t first = 0; first < out.size(); first += width) {
    const std::size_t count = std::min(width, out.size() - first);
    const LaneInput input(q.data() + first * dof, count, dof, width);
    detail::FastNearest nearest[kMaxLanes];
    kernels_->clearances(detail::FastAccess::data(robot_).tables, world_->tables, input.q,
                         static_cast<float>(detail::kMaxClearance), false, nearest);
    for (std::size_t k = 0; k < count; ++k) out[first + k] = clearance_of(nearest[k]);
  }
}

FastChecker::LeastClearance FastChecker::least_clearance(std::span<const double> q) const noexcept {
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
