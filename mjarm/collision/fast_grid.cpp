#include <algorithm>
#include <array>
#include <cmath>

#include "mjarm/collision/fast_grid_internal.hpp"
#include "mjarm/collision/fast_robot_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr int kMaxApart = 15;       // cells; distances are cut off there
constexpr int kCountsPerCell = 16;  // unit of the distances
constexpr int kLeastSide = 24, kMaxSide = 64;

int squared(int x) { return x * x; }

/// Squared distance, in cells, of two cells so many apart: their nearest faces count.
int apart2(int cells) { return squared(std::max(std::abs(cells) - 1, 0)); }

/// Squared distances to the nearest mark of the same row.
void look_along_row(const std::uint8_t* marks, std::size_t side, std::uint16_t* out) {
  int far = kMaxApart + 1;
  for (std::size_t x = 0; x < side; ++x) {
    far = marks[x] != 0 ? 0 : std::min(far + 1, kMaxApart + 1);
    out[x] = static_cast<std::uint16_t>(apart2(far));
  }
  far = kMaxApart + 1;
  for (std::size_t x = side; x-- > 0;) {
    far = marks[x] != 0 ? 0 : std::min(far + 1, kMaxApart + 1);
    out[x] = std::min(out[x], static_cast<std::uint16_t>(apart2(far)));
  }
}

/// For every row the least of the rows round it, `stride` rows apart, each with its own distance
/// added (P. Felzenszwalb and D. Huttenlocher, 2012: one axis after the other).
/// @param place  place(row): how far it is along the axis.
template <class Place>
void look_across_rows(const std::vector<std::uint16_t>& from, std::size_t side, std::size_t stride,
                      const Place& place, std::vector<std::uint16_t>& to) {
  to = from;
  for (std::size_t row = 0; row < side * side; ++row) {
    const int at = static_cast<int>(place(row));
    std::uint16_t* const out = &to[row * side];
    for (int k = std::max(-kMaxApart, -at);
         k <= std::min(kMaxApart, static_cast<int>(side) - 1 - at); ++k) {
      const std::uint16_t* const in = from.data() + (static_cast<std::ptrdiff_t>(row) +
                                                     k * static_cast<std::ptrdiff_t>(stride)) *
                                                        static_cast<std::ptrdiff_t>(side);
      const auto more = static_cast<std::uint16_t>(apart2(k));
      for (std::size_t x = 0; x < side; ++x) {
        const auto sum = static_cast<std::uint16_t>(in[x] + more);
        out[x] = sum < out[x] ? sum : out[x];
      }
    }
  }
}

/// Roots of squared distances in counts, rounded down.
std::array<std::uint8_t, kMaxApart * kMaxApart + 1> root_table() {
  std::array<std::uint8_t, kMaxApart * kMaxApart + 1> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<std::uint8_t>(kCountsPerCell * std::sqrt(static_cast<double>(i)));
  }
  return out;
}

}  // namespace

FastGridCells::FastGridCells(const Eigen::Vector3d& middle, double reach, std::size_t leaves) {
  const double side = 12 * std::pow(static_cast<double>(leaves), 0.15);
  side_ = static_cast<std::size_t>(std::clamp(static_cast<int>(side), kLeastSide, kMaxSide));
  // One cell of margin on each side.
  size_ = std::max(2 * reach, 1e-3) / static_cast<double>(side_ - 2);
  low_ = middle - Eigen::Vector3d::Constant(0.5 * size_ * static_cast<double>(side_));
  cells_.assign(side_ * side_ * side_ + 3, 0);  // four bytes are read at once
}

double FastGridCells::cell_radius() const { return 0.5 * std::sqrt(3.0) * size_ * (1 + 1e-9); }

/// What is outside of the grid counts as at its border, which is nearer to all that is inside.
FastGridCells::Range FastGridCells::cells_of(const FastBounds& bounds) const {
  Range out;
  const double last = static_cast<double>(side_) - 1;
  const double per_meter = 1 / size_;
  const auto cell = [&](double x) {
    return static_cast<int>(std::clamp(x * per_meter, 0.0, last));
  };
  for (int k = 0; k < 3; ++k) {
    out.first[k] = cell(bounds.low[k] - low_[k] - 1e-9);
    out.last[k] = cell(bounds.high[k] - low_[k] + 1e-9);
  }
  return out;
}

void FastGridCells::finish(double lack) {
  std::vector<std::uint16_t> one(side_ * side_ * side_), other;
  if (work_ <= kMaxGridWork) {
    for (std::size_t row = 0; row < side_ * side_; ++row) {
      look_along_row(&cells_[row * side_], side_, &one[row * side_]);
    }
    look_across_rows(one, side_, 1, [&](std::size_t row) { return row % side_; }, other);
    look_across_rows(other, side_, side_, [&](std::size_t row) { return row / side_; }, one);
  }
  const auto roots = root_table();
  const auto lack_counts =
      static_cast<int>(std::ceil(std::min(kCountsPerCell * lack / size_, 255.0)));
  for (std::size_t z = 0, i = 0; z < side_; ++z) {
    for (std::size_t y = 0; y < side_; ++y) {
      for (std::size_t x = 0; x < side_; ++x, ++i) {
        // Points outside of the grid are looked up at its border: nothing is known there.
        const bool border = std::min({x, y, z}) == 0 || std::max({x, y, z}) == side_ - 1;
        const int counts = border ? 0 : roots[one[i]] - lack_counts;
        cells_[i] = static_cast<std::uint8_t>(std::max(counts, 0));
      }
    }
  }
  tables_.cells = cells_.data();
  tables_.side = static_cast<int>(side_);
  for (int k = 0; k < 3; ++k) tables_.low[k] = static_cast<float>(low_[k]);
  tables_.per_meter = static_cast<float>(1 / size_);
  // Rounding takes a point into the next cell by less than this.
  const double size = size_ * static_cast<double>(side_) + low_.cwiseAbs().maxCoeff();
  tables_.slack = round_up(1e-6 + 0x1p-20 * size);
  tables_.unit = round_down(size_ / kCountsPerCell * (1 - 1e-5));
}

}  // namespace mjarm::detail
