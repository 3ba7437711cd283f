#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "mjarm/collision/obstacles.hpp"

namespace mjarm::detail {

/// [m] from a point to a triangle, which may be a line or a point (C. Ericson, 2005, 5.1.5).
[[nodiscard]] double distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Calls visit(low, high) for the box of every cell of a height field, in its frame.
template <class Visit>
void for_each_column(const HeightFieldShape& field, const Visit& visit) {
  const double dx = 2 * field.half.x() / (field.cols - 1),
               dy = 2 * field.half.y() / (field.rows - 1);
  for (int r = 0; r + 1 < field.rows; ++r) {
    for (int c = 0; c + 1 < field.cols; ++c) {
      const double* const h = &field.heights[static_cast<std::size_t>(r * field.cols + c)];
      const double top = std::max({h[0], h[1], h[field.cols], h[field.cols + 1]});
      const double x = -field.half.x() + c * dx, y = -field.half.y() + r * dy;
      visit(Eigen::Vector3d(x, y, field.bottom), Eigen::Vector3d(x + dx, y + dy, top));
    }
  }
}

/// Whether points are inside of a closed mesh: whether a ray leaves it an odd number of times.
class InsideTest {
 public:
  InsideTest(std::span<const Eigen::Vector3d> vertices, std::span<const std::array<int, 3>> faces);

  /// A point on the surface may be either.
  [[nodiscard]] bool is_inside(const Eigen::Vector3d& p) const;

 private:
  enum class Crossing { none, one, unclear };
  [[nodiscard]] Crossing crossing(const std::array<int, 3>& face, const Eigen::Vector3d& p) const;
  [[nodiscard]] const std::vector<int>* faces_above(const Eigen::Vector3d& p) const;

  std::vector<Eigen::Vector3d> vertices_;  // turned, so that rays along z meet few edges
  std::span<const std::array<int, 3>> faces_;
  Eigen::Vector3d low_, high_;
  int bins_ = 1;  // along x and y
  std::vector<std::vector<int>> faces_of_bin_;
};

}  // namespace mjarm::detail
