#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace mjarm::view {

/// The last moments of a simulation, for going back in time and forth again.
template <class T>
class History {
 public:
  /// @param max  moments kept, >= 1; then the oldest one makes room.
  explicit History(std::size_t max) : max_(std::max<std::size_t>(max, 1)) {}

  /// Adds a moment after the one that is looked at; those that came after it are forgotten.
  void add(const T& moment) {
    size_ -= back_;
    back_ = 0;
    if (size_ == moments_.size() && size_ < max_) moments_.emplace_back();
    if (size_ == max_) {
      first_ = (first_ + 1) % max_;
      --size_;
    }
    moments_[(first_ + size_) % moments_.size()] = moment;
    ++size_;
  }
  void clear() {
    moments_.clear();
    first_ = size_ = back_ = 0;
  }
  /// Looks at the moment before.
  /// @return null where there is none.
  [[nodiscard]] const T* back() {
    if (back_ + 1 >= size_) return nullptr;
    ++back_;
    return &at();
  }
  /// Looks at the moment after.
  /// @return null at the latest one.
  [[nodiscard]] const T* forward() {
    if (back_ == 0) return nullptr;
    --back_;
    return &at();
  }
  /// Looks at the latest moment again.
  void to_present() noexcept { back_ = 0; }
  /// False at the latest moment.
  [[nodiscard]] bool is_past() const noexcept { return back_ > 0; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// The moment that is looked at; there is one.
  [[nodiscard]] const T& at() const {
    return moments_[(first_ + size_ - 1 - back_) % moments_.size()];
  }

 private:
  std::size_t max_;
  std::vector<T> moments_;  ///< a ring from `first_`, once it is full
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::size_t back_ = 0;  ///< moments between the one looked at and the latest one
};

}  // namespace mjarm::view
