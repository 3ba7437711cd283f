#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mjarm/rl/float_buffer_internal.hpp"
#include "mjarm/rl/networks_internal.hpp"

namespace mjarm::rl::detail {

/// The gradient of a batch that is cut into slices: each has a gradient of its own, and these are
/// added in order, so that the number of threads changes no bit.
class GradientSums {
 public:
  /// @param parameters  numbers of a gradient.
  /// @param portion     how many of them a task takes, 1 to 2^16; squares() depends on it in the
  ///                    last digits.
  /// @param networks    must outlive this.
  GradientSums(std::size_t parameters, std::size_t portion, Networks& networks);

  /// There are at least so many slices then.
  void reserve(int slices);
  [[nodiscard]] float* slice(int i) noexcept { return slices_[static_cast<std::size_t>(i)].data(); }
  /// gradient() is the sum of the first `slices` then.
  void add(int slices);
  [[nodiscard]] std::span<float> gradient() noexcept { return {sum_.data(), sum_.size()}; }
  [[nodiscard]] std::size_t size() const noexcept { return sum_.size(); }
  /// |gradient()|^2
  [[nodiscard]] double squares();

 private:
  [[nodiscard]] std::size_t portions() const { return (size() + portion_ - 1) / portion_; }
  /// Calls body(number of a portion, where it begins, its length) for all of them.
  template <class Body>
  void for_each_portion(const Body& body);

  std::size_t portion_;
  Networks& networks_;
  FloatBuffer sum_;
  std::vector<FloatBuffer> slices_;
};

}  // namespace mjarm::rl::detail
