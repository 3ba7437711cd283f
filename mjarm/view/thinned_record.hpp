#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace mjarm::view {

/// The moments of a run from its beginning on, in bounded memory. When it is full every second
/// moment goes, and from then on half as many are kept: they are evenly spaced however long the run
/// gets.
template <class T>
class ThinnedRecord {
 public:
  /// @param max  moments kept, >= 2.
  explicit ThinnedRecord(std::size_t max) : max_(std::max<std::size_t>(max, 2)) {}

  /// One more step was made; `make()` gives its moment, and is asked only where it is kept.
  /// @param time [s] greater than that of the step before.
  template <class Make>
  void add(double time, const Make& make) {
    assert(moments_.empty() || time > moments_.back().time);
    if (steps_ % spacing_ == 0 && moments_.size() == max_) thin();
    if (steps_++ % spacing_ == 0) moments_.push_back({time, make()});
  }
  void clear() {
    moments_.clear();
    steps_ = 0;
    spacing_ = 1;
  }

  [[nodiscard]] std::size_t size() const noexcept { return moments_.size(); }
  [[nodiscard]] bool empty() const noexcept { return moments_.empty(); }
  /// Steps from one moment to the next.
  [[nodiscard]] std::size_t spacing() const noexcept { return spacing_; }
  /// [s] of the i-th moment that is kept, ascending.
  [[nodiscard]] double time(std::size_t i) const { return moments_[i].time; }
  [[nodiscard]] const T& at(std::size_t i) const { return moments_[i].what; }
  /// Index of the moment nearest to `time` [s], the earlier one of two as near; there is one.
  [[nodiscard]] std::size_t nearest(double time) const {
    assert(!empty());
    const auto after = std::lower_bound(moments_.begin(), moments_.end(), time,
                                        [](const Moment& m, double t) { return m.time < t; });
    const auto i = static_cast<std::size_t>(after - moments_.begin());
    if (i == 0) return 0;
    if (i == size()) return size() - 1;
    return time - this->time(i - 1) <= this->time(i) - time ? i - 1 : i;
  }

 private:
  struct Moment {
    double time;
    T what;
  };
  /// Those at multiples of twice the spacing stay.
  void thin() {
    for (std::size_t i = 1; 2 * i < moments_.size(); ++i) {
      moments_[i] = std::move(moments_[2 * i]);
    }
    moments_.erase(moments_.begin() + static_cast<std::ptrdiff_t>((moments_.size() + 1) / 2),
                   moments_.end());
    spacing_ *= 2;
  }

  std::size_t max_;
  std::vector<Moment> moments_;
  std::size_t steps_ = 0;    ///< that were added
  std::size_t spacing_ = 1;  ///< [steps]
};

}  // namespace mjarm::view
