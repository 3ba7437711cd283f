#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/collision/cover_fit_internal.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kLeastCell = 1.0 / 24;     // half width of the least cell, as share of the bound
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
    for (std::size_t i = 0; i < solids_.size(); ++i) lists_.push_back(static_cast<int>(i));
    const List solids{0, lists_.size()};
    for (std::size_t i = 0; i < spheres_.size(); ++i) lists_.push_back(static_cast<int>(i));
    const List spheres{solids.end, lists_.size()};
    look({0.5 * (bounds.low + bounds.high), 0.5 * (bounds.high - bounds.low)}, solids, spheres);
    return std::move(gaps_);
  }

 private:
  /// A part of lists_.
  struct List {
    std::size_t begin, end;
  };

  static double farthest2(const Cell& cell, const Vector3d& center) {
    return ((cell.center - center).cwiseAbs() + cell.half).squaredNorm();
  }

  /// `solids` and `spheres`: those that the cell above this one meets.
  void look(const Cell& cell, List solids, List spheres) {
    if (gaps_.size() >= kMaxGaps) return;
    const std::size_t before = lists_.size();
    look_closer(cell, solids, spheres);
    lists_.resize(before);
  }

  void look_closer(const Cell& cell, List solids, List spheres) {
    const double round = cell.half.norm();
    List near_spheres{lists_.size(), 0};
    for (std::size_t k = spheres.begin; k < spheres.end; ++k) {
      const auto i = static_cast<std::size_t>(lists_[k]);
      const Sphere& sphere = spheres_[i];
      if (farthest2(cell, sphere.center) <= sphere.radius * sphere.radius) return;
      const double reach = max_[i] + round;
      if ((cell.center - sphere.center).squaredNorm() < reach * reach) lists_.push_back(lists_[k]);
    }
    near_spheres.end = lists_.size();
    List near_solids{near_spheres.end, 0};
    for (std::size_t k = solids.begin; k < solids.end; ++k) {
      const CoverSolid& solid = solids_[static_cast<std::size_t>(lists_[k])];
      if (solid.is_within(cell.center, round)) lists_.push_back(lists_[k]);
    }
    near_solids.end = lists_.size();
    if (near_solids.begin == near_solids.end) return;
    Eigen::Index widest = 0;
    const double half = cell.half.maxCoeff(&widest);
    if (half <= kLeastCell * bound_ || ++cells_ > kMaxCells) {
      fill(cell, near_solids, near_spheres);
      return;
    }
    if (near_spheres.begin == near_spheres.end &&
        is_near_gap(cell.center, kApart * bound_ - round)) {
      return;
    }
    Cell child = cell;
    child.half[widest] *= 0.5;
    for (const double side : {-1.0, 1.0}) {
      child.center[widest] = cell.center[widest] + side * child.half[widest];
      look(child, near_solids, near_spheres);
    }
  }

  /// Grows the sphere that needs it least.
  void fill(const Cell& cell, List solids, List spheres) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t which = 0;
    for (std::size_t k = spheres.begin; k < spheres.end; ++k) {
      const auto i = static_cast<std::size_t>(lists_[k]);
      const double radius = std::sqrt(farthest2(cell, spheres_[i].center));
      if (radius > max_[i] || radius - spheres_[i].radius >= least) continue;
      least = radius - spheres_[i].radius;
      which = i;
    }
    if (!std::isinf(least)) {
      spheres_[which].radius += least;
      return;
    }
    for (std::size_t k = solids.begin; k < solids.end; ++k) {
      const CoverSolid& solid = solids_[static_cast<std::size_t>(lists_[k])];
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
  std::vector<int> lists_;   // of the cell that is looked at, and of all above it
  std::vector<Vector3d> gaps_;
  std::size_t cells_ = 0;
};

}  // namespace

std::vector<Vector3d> seal_cover(std::span<const CoverSolid> solids, std::span<Sphere> spheres,
                                 double bound) {
  return CoverSeal(solids, spheres, bound).run();
}

}  // namespace mjarm::detail
