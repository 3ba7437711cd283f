#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>

#include "mjarm/collision/cover_fit_internal.hpp"
#include "mjarm/collision/set_cover_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSpare = 0.15;      // share of the bound that is left for the seal
constexpr double kMaxPoints = 6000;  // of a grid
constexpr int kRounds = 100;         // of the set cover, the first time
constexpr int kMoreRounds = 50;      // after points were added
constexpr int kSearches = 10;        // from then on spheres are only added
constexpr int kMaxSeals = 60;

/// The middles of the cells of a grid of about that spacing, within a distance of the solids.
template <class Keep>
void over_grid(std::span<const CoverSolid> solids, double spacing, Keep keep) {
  const CoverBounds bounds = bounds_of(solids);
  const Vector3d size = bounds.high - bounds.low;
  const double coarse = std::cbrt(size.prod() / kMaxPoints);
  const Eigen::Array3i n = (size.array() / std::max(spacing, coarse)).ceil().cast<int>().max(1);
  const Vector3d cell = size.array() / n.cast<double>();
  for (int i = 0; i < n.x(); ++i) {
    for (int j = 0; j < n.y(); ++j) {
      for (int k = 0; k < n.z(); ++k) {
        keep(bounds.low + cell.cwiseProduct(Vector3d(i + 0.5, j + 0.5, k + 0.5)));
      }
    }
  }
}

/// One point for every cell of a grid.
class Thinner {
 public:
  explicit Thinner(double cell) : cell_(cell) {}
  bool is_new(const Vector3d& p) {
    const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell_)); };
    return seen_.insert({index(p.x()), index(p.y()), index(p.z())}).second;
  }

 private:
  double cell_;
  std::set<std::array<std::int64_t, 3>> seen_;
};

/// From a point of a solid inwards, as long as the depth grows as fast as the way: a sphere round
/// where that ends contains the one round the start.
/// @param depth  of `p`.
Vector3d to_middle(const CoverSolid& solid, const Vector3d& p, double depth) {
  constexpr double kRate = 0.97;
  const Vector3d inwards = -solid.outwards(p);
  const double max = solid.kind == SolidKind::hull ? 0.5 : solid.size.maxCoeff() + depth;
  const auto grown = [&](double way) { return -solid.signed_distance(p + way * inwards) - depth; };
  const auto grows = [&](double way) { return grown(way) >= kRate * way; };
  double low = 0, high = max;
  const auto bisect = [&](const auto& goes_on) {
    low = 0, high = max;
    for (int i = 0; i < 14; ++i) {
      const double way = 0.5 * (low + high);
      (goes_on(way) ? low : high) = way;
    }
  };
  if (solid.kind != SolidKind::hull) {
    bisect(grows);
    return p + low * inwards;
  }
  // Of a hull the end is known; where it is so clear that no rounding could have decided in another
  // way, it stands. The depth is a concave function of the way.
  const Vector3d way_S = solid.X_LS.R.transpose() * inwards;
  const double end = solid.facets.falls_along(solid.in_own_frame(p), way_S, -depth, kRate);
  bisect([&](double way) { return way <= end; });
  const bool is_clear = (low == 0 || grown(low) > kRate * low + 1e-8) &&
                        (high == max || grown(high) < kRate * high - 1e-12);
  if (!is_clear) bisect(grows);
  return p + low * inwards;
}

class CoverFit {
 public:
  CoverFit(std::span<const CoverSolid> solids, double bound, const StopCheck& stop)
      : solids_(solids), bound_(bound), stop_(stop) {
    add_candidates();
    add_points();
  }

  std::optional<FittedCover> run(std::size_t max) {
    for (int seal = 0; seal < kMaxSeals; ++seal) {
      if (is_stopped(stop_)) return std::nullopt;
      FittedCover out;
      const int rounds = seal == 0 ? kRounds : seal < kSearches ? kMoreRounds : 0;
      for (const int c : cover_.solve(rounds)) {
        out.spheres.push_back(candidates_[static_cast<std::size_t>(c)]);
      }
      if (out.spheres.size() > max) return std::nullopt;
      const std::vector<Vector3d> gaps = seal_cover(solids_, out.spheres, bound_);
      if (gaps.empty()) {
        for (const Sphere& sphere : out.spheres) {
          out.bound = std::max(out.bound, sphere.radius - depth_in(solids_, sphere.center));
        }
        return out;
      }
      for (const Vector3d& gap : gaps) {
        if (is_stopped(stop_)) return std::nullopt;
        add_point(gap);
      }
    }
    return std::nullopt;
  }

 private:
  /// A sphere that sticks out by a little less than the bound.
  int add_candidate(const Vector3d& p) {
    const double radius = (1 - kSpare) * bound_ + depth_in(solids_, p);
    std::vector<int> points;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if ((points_[k] - p).squaredNorm() <= radius * radius) points.push_back(static_cast<int>(k));
    }
    candidates_.push_back({p, radius});
    return cover_.add_set(points);
  }

  void add_point(const Vector3d& p) {
    std::vector<int> holders;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const double radius = candidates_[c].radius;
      if ((candidates_[c].center - p).squaredNorm() <= radius * radius) {
        holders.push_back(static_cast<int>(c));
      }
    }
    if (holders.empty()) holders.push_back(add_candidate(p));
    points_.push_back(p);
    cover_.add_element(std::move(holders));
  }

  void add_candidates() {
    Thinner thinner(0.25 * bound_);
    for (const CoverSolid& solid : solids_) {
      over_grid({&solid, 1}, 0.5 * bound_, [&](const Vector3d& p) {
        if (is_stopped(stop_)) return;
        const double distance = solid.signed_distance(p);
        if (distance >= 0) return;
        const Vector3d middle = to_middle(solid, p, -distance);
        if (thinner.is_new(middle)) add_candidate(middle);
      });
    }
  }

  /// Points of the surface, and a few from inside.
  void add_points() {
    Thinner thinner(0.25 * bound_);
    const auto add = [&](const Vector3d& p) {
      if (is_stopped(stop_)) return;
      if (depth_in(solids_, p) < 0.1 * bound_ && thinner.is_new(p)) add_point(p);
    };
    for (const CoverSolid& solid : solids_) {
      for (const Vector3d& p : solid.sharp_points(0.5 * bound_)) add(p);
      over_grid({&solid, 1}, 0.6 * bound_, [&](const Vector3d& p) {
        const double distance = solid.signed_distance(p);
        if (std::abs(distance) > 0.6 * bound_) return;
        const auto foot = solid.point_within(p - distance * solid.outwards(p), 0.05 * bound_);
        if (foot) add(*foot);
      });
    }
    over_grid(solids_, 2 * bound_, [&](const Vector3d& p) {
      if (depth_in(solids_, p) > 0) add_point(p);
    });
    if (points_.empty()) add_point(solids_.front().X_LS.p);
  }

  std::span<const CoverSolid> solids_;
  double bound_;
  const StopCheck& stop_;
  std::vector<Sphere> candidates_;
  std::vector<Vector3d> points_;
  SetCover cover_;  // of the points by the candidates
};

}  // namespace

std::optional<FittedCover> fit_cover(std::span<const CoverSolid> solids, double bound,
                                     std::size_t max, const StopCheck& stop) {
  return CoverFit(solids, bound, stop).run(max);
}

}  // namespace mjarm::detail
