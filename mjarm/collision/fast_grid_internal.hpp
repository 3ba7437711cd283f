#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mjarm/collision/fast_tree_internal.hpp"

namespace mjarm::detail {

/// The array behind a FastGrid. First everything is marked, then finish() turns marks into
/// distances. Takes a bounded time whatever is marked: where that would take longer, nothing is
/// ruled out.
class FastGridCells {
 public:
  FastGridCells() = default;
  /// Of what is within `reach` of `middle`, both in frame 0 [m]; the grid is finer for more leaves.
  FastGridCells(const Eigen::Vector3d& middle, double reach, std::size_t leaves);

  [[nodiscard]] double cell_size() const { return size_; }
  /// [m] half of a cell's diagonal.
  [[nodiscard]] double cell_radius() const;

  /// Marks the cells that a box with sides along the axes meets.
  void mark(const FastBounds& bounds) {
    mark(bounds, [](const Eigen::Vector3d&) { return true; });
  }
  /// Of these those for whose middle `meets` is true: it must be where the solid is within
  /// cell_radius().
  template <class Meets>
  void mark(const FastBounds& bounds, const Meets& meets);

  /// @param lack  [m] by how much what was marked is larger than its marks.
  void finish(double lack);
  [[nodiscard]] const FastGrid& tables() const { return tables_; }

 private:
  struct Range {
    int first[3], last[3];
  };
  [[nodiscard]] Range cells_of(const FastBounds& bounds) const;
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * side_ + static_cast<std::size_t>(y)) * side_ +
           static_cast<std::size_t>(x);
  }

  std::size_t side_ = 0;
  double size_ = 0;  // [m] of a cell
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  std::int64_t work_ = 0;  // cells that were looked at
  std::vector<std::uint8_t> cells_;
  FastGrid tables_;
};

/// Cells that all marks together may look at.
inline constexpr std::int64_t kMaxGridWork = 4'000'000;

template <class Meets>
void FastGridCells::mark(const FastBounds& bounds, const Meets& meets) {
  const Range range = cells_of(bounds);
  std::int64_t count = 1;
  for (int k = 0; k < 3; ++k) count *= range.last[k] - range.first[k] + 1;
  work_ += count;
  if (work_ > kMaxGridWork) return;
  for (int z = range.first[2]; z <= range.last[2]; ++z) {
    for (int y = range.first[1]; y <= range.last[1]; ++y) {
      for (int x = range.first[0]; x <= range.last[0]; ++x) {
        std::uint8_t& cell = cells_[index(x, y, z)];
        if (cell != 0) continue;
        if (count <= 4 || meets(low_ + size_ * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5))) {
          cell = 1;
        }
      }
    }
  }
}

}  // namespace mjarm::detail
