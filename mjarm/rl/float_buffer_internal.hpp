#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

namespace mjarm::rl::detail {

/// Floats that begin where a cache line does, 0 at first; of one size for life.
class FloatBuffer {
 public:
  FloatBuffer() = default;
  explicit FloatBuffer(std::size_t size)
      : data_(static_cast<float*>(::operator new[](size * sizeof(float), kLine))), size_(size) {
    std::fill_n(data_.get(), size, 0.0F);
  }

  [[nodiscard]] float* data() noexcept { return data_.get(); }
  [[nodiscard]] const float* data() const noexcept { return data_.get(); }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  static constexpr std::align_val_t kLine{64};
  struct Delete {
    void operator()(float* data) const noexcept { ::operator delete[](data, kLine); }
  };
  std::unique_ptr<float, Delete> data_;
  std::size_t size_ = 0;
};

}  // namespace mjarm::rl::detail
