#pragma once

#include <concepts>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "mjarm/collision/exact.hpp"

namespace mjarm {

/// How far an arm is from touching anything.
struct Clearance {
  double distance = std::numeric_limits<double>::infinity();  ///< [m] < 0: overlap by so much
  GeomPair pair;                                              ///< the two that are nearest
};

/// Measures a configuration, shape (dof,) [rad or m]. Must not throw. Empty: there is none.
class ClearanceCheck {
 public:
  using IsFree = std::function<bool(std::span<const double> q)>;

  ClearanceCheck() = default;
  /// @param measure  what gets q and returns the Clearance.
  /// @param is_free  whether nothing overlaps there, where that can be told more quickly.
  template <std::invocable<std::span<const double>> Measure>
    requires(!std::same_as<std::remove_cvref_t<Measure>, ClearanceCheck>)
  ClearanceCheck(Measure&& measure, IsFree is_free = {})
      : measure_(std::forward<Measure>(measure)), is_free_(std::move(is_free)) {}

  explicit operator bool() const { return static_cast<bool>(measure_); }
  [[nodiscard]] Clearance operator()(std::span<const double> q) const { return measure_(q); }
  /// Whether nothing overlaps.
  [[nodiscard]] bool is_free(std::span<const double> q) const {
    return is_free_ ? is_free_(q) : measure_(q).distance >= 0;
  }

 private:
  std::function<Clearance(std::span<const double> q)> measure_;
  IsFree is_free_;
};

/// By the exact checker, a copy of which the result holds; distances beyond the checker's margin
/// count as infinite. Copies share that checker, so each thread needs a check of its own.
[[nodiscard]] ClearanceCheck clearance_check(const ExactChecker& checker);

}  // namespace mjarm
