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
  using AtLeast = std::function<double(std::span<const double> q)>;

  ClearanceCheck() = default;
  /// @param measure  what gets q and returns the Clearance.
  /// @param is_free   whether nothing overlaps there, where that can be told more quickly.
  /// @param at_least  [m] a bound of the distance, where one is known without measuring.
  template <std::invocable<std::span<const double>> Measure>
    requires(!std::same_as<std::remove_cvref_t<Measure>, ClearanceCheck>)
  ClearanceCheck(Measure&& measure, IsFree is_free = {}, AtLeast at_least = {})
      : measure_(std::forward<Measure>(measure)),
        is_free_(std::move(is_free)),
        at_least_(std::move(at_least)) {}

  explicit operator bool() const { return static_cast<bool>(measure_); }
  [[nodiscard]] Clearance operator()(std::span<const double> q) const { return measure_(q); }
  /// Whether nothing overlaps.
  [[nodiscard]] bool is_free(std::span<const double> q) const {
    return is_free_ ? is_free_(q) : measure_(q).distance >= 0;
  }
  /// [m] The distance is not less; minus infinity where nothing is known.
  [[nodiscard]] double at_least(std::span<const double> q) const {
    return at_least_ ? at_least_(q) : -std::numeric_limits<double>::infinity();
  }

 private:
  std::function<Clearance(std::span<const double> q)> measure_;
  IsFree is_free_;
  AtLeast at_least_;
};

/// By the exact checker, a copy of which the result holds; distances beyond the checker's margin
/// count as infinite. Copies share that checker, so each thread needs a check of its own.
[[nodiscard]] ClearanceCheck clearance_check(const ExactChecker& checker);

}  // namespace mjarm
