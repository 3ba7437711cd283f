#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mjarm::detail {

/// Boxes along the axes of the world, for a first look at which of many are near: several at once,
/// in single precision.
class NearBoxes {
 public:
  static constexpr std::size_t kWord = 64;  ///< boxes that a bit each stands for

  void add(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  [[nodiscard]] std::size_t words() const noexcept { return (size_ + kWord - 1) / kWord; }

  /// Which of the boxes [kWord * word, kWord * (word + 1)) are no farther than `within` [m] from
  /// `p`, the first in the lowest bit; some that are a little farther are among them.
  [[nodiscard]] std::uint64_t near(std::size_t word, const Eigen::Vector3d& p,
                                   double within) const noexcept;

 private:
  std::size_t size_ = 0;
  std::vector<float> rows_;  // of each few boxes: low x, high x, low y, ...
};

}  // namespace mjarm::detail
