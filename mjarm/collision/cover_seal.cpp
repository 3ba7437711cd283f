#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/collision/cover_fit_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kLeastCell = 1.0 / 48;     // half width of the least cell, as share of the bound
constexpr double kApart = 0.25;             // of gaps, as share of the bound
constexpr std::size_t kMaxGaps = 200;       // more are not gathered
constexpr std::size_t kMaxCells = 4000000;  // more are given up, as gaps

struct Cell {
  Vector3d center, half;
};

class CoverSeal {
 public:
  CoverSeal(std::span<const CoverSolid> solids, std::span<Sphere> spheres, double bound)
      : solids_(solids), spheres_(spheres), bound_(bound) {
    for (const Sphere& sphere : spheres) {
      max_.push_back(bound + depth_in(solids, sphere.center));
    }
  }

  std::vector<Vector3d> run() {
    const CoverBounds bounds = bounds_of(solids_);
    std::vector<int> solids(solids_.size()), spheres(spheres_.size());
    for (std::size_t i = 0; i < solids.size(); ++i) solids[i] = static_cast<int>(i);
    for (std::size_t i = 0; i < spheres.size(); ++i) spheres[i] = static_cast<int>(i);
    look({0.5 * (bounds.low + bounds.high), 0.5 * (bounds.high - bounds.low)}, solids, spheres);
    return std::move(gaps_);
  }

 private:
  static double farthest(const Cell& cell, const Vector3d& center) {
    return ((cell.center - center).cwiseAbs() + cell.half).norm();
  }

  /// `solids` and `spheres`: those that the cell above this one meets.
  void look(const Cell& cell, const std::vector<int>& solids, const std::vector<int>& spheres) {
    if (gaps_.size() >= kMaxGaps) return;
    const double round = cell.half.norm();
    std::vector<int> near_solids, near_spheres;
    for (const int i : solids) {
      const CoverSolid& solid = solids_[static_cast<std::size_t>(i)];
      if (solid.signed_distance(cell.center) <= round) near_solids.push_back(i);
    }
    if (near_solids.empty()) return;
    for (const int i : spheres) {
      const Sphere& sphere = spheres_[static_cast<std::size_t>(i)];
      if (farthest(cell, sphere.center) <= sphere.radius) return;
      const double reach = max_[static_cast<std::size_t>(i)] + round;
      if ((cell.center - sphere.center).squaredNorm() < reach * reach) near_spheres.push_back(i);
    }
    Eigen::Index widest = 0;
    const double half = cell.half.maxCoeff(&widest);
    if (half <= kLeastCell * bound_ || ++cells_ > kMaxCells) {
      fill(cell, near_solids, near_spheres);
      return;
    }
    if (near_spheres.empty() && is_near_gap(cell.center, kApart * bound_ - round)) return;
    Cell child = cell;
    child.half[widest] *= 0.5;
    for (const double side : {-1.0, 1.0}) {
      child.center[widest] = cell.center[widest] + side * child.half[widest];
      look(child, near_solids, near_spheres);
    }
  }

  /// Grows the sphere that needs it least.
  void fill(const Cell& cell, const std::vector<int>& solids, const std::vector<int>& spheres) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t which = 0;
    for (const int k : spheres) {
      const auto i = static_cast<std::size_t>(k);
      const double radius = farthest(cell, spheres_[i].center);
      if (radius > max_[i] || radius - spheres_[i].radius >= least) continue;
      least = radius - spheres_[i].radius;
      which = i;
    }
    if (!std::isinf(least)) {
      spheres_[which].radius += least;
      return;
    }
    for (const int i : solids) {
      const CoverSolid& solid = solids_[static_cast<std::size_t>(i)];
      const auto point = solid.point_within(cell.center, cell.half.norm());
      if (point && !is_near_gap(*point, kApart * bound_)) gaps_.push_back(*point);
    }
  }

  bool is_near_gap(const Vector3d& p, double within) const {
    return std::any_of(gaps_.begin(), gaps_.end(),
                       [&](const Vector3d& gap) { return (gap - p).norm() < within; });
  }

  std::span<const CoverSolid> solids_;
  std::span<Sphere> spheres_;
  double bound_;
  std::vector<double> max_;  // largest radius of each sphere
  std::vector<Vector3d> gaps_;
  std::size_t cells_ = 0;
};

}  // namespace

std::vector<Vector3d> seal_cover(std::span<const CoverSolid> solids, std::span<Sphere> spheres,
                                 double bound) {
  return CoverSeal(solids, spheres, bound).run();
}

}  // namespace mjarm::detail
