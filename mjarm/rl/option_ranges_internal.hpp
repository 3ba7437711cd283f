#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm::rl::detail {

/// Where the number of an option must lie.
struct OptionRange {
  double least;
  double most = std::numeric_limits<double>::max();
  bool above = false;  ///< `least` itself is too little

  /// False for what is not a number.
  [[nodiscard]] bool holds(double value) const noexcept {
    return (above ? value > least : value >= least) && value <= most;
  }
};

inline constexpr OptionRange kAboveZero{.least = 0, .above = true};
inline constexpr OptionRange kZeroOrMore{.least = 0};
inline constexpr OptionRange kShare{.least = 0, .most = 1};
inline constexpr OptionRange kShareAboveZero{.least = 0, .most = 1, .above = true};
inline constexpr OptionRange kThreads{.least = 1, .most = 1024};

/// `in [0, 1]`, `> 0`: the range in the language in use.
[[nodiscard]] std::string in_words(const OptionRange& range);

/// @return the fault of an option with this value, in words; empty where there is none.
[[nodiscard]] std::string range_fault(std::string_view name, const OptionRange& range,
                                      double value);

/// The same for an option of any type: a number, or each number of a list.
template <class T>
[[nodiscard]] std::string range_fault(std::string_view name, const OptionRange& range,
                                      const std::vector<T>& list) {
  for (const T& value : list) {
    if (std::string fault = range_fault(name, range, static_cast<double>(value)); !fault.empty()) {
      return fault;
    }
  }
  return {};
}

/// What a table of options calls for each of its lines; this one looks at the ranges and keeps the
/// first fault. A table is a function that calls `visit(section, key, value[, range])` for each
/// option, in the order of the file: numbers and lists of numbers have a range, words have none.
class RangeCheck {
 public:
  /// @param named  sections whose name goes before the key, as in `reward.distance`.
  explicit RangeCheck(std::string_view named = {}) noexcept : named_(named) {}

  template <class T>
  void operator()(std::string_view /*section*/, std::string_view /*key*/, const T& /*word*/) {
    static_assert(std::is_enum_v<T> || std::is_same_v<T, bool>, "a number needs a range");
  }
  template <class T>
  void operator()(std::string_view section, std::string_view key, const T& value,
                  const OptionRange& range) {
    if (!fault_.empty()) return;
    const std::string name =
        section == named_ ? std::string(section) + '.' + std::string(key) : std::string(key);
    if constexpr (std::is_arithmetic_v<T>) {
      fault_ = range_fault(name, range, static_cast<double>(value));
    } else {
      fault_ = range_fault(name, range, value);
    }
  }

  [[nodiscard]] Result<void> result() const {
    if (!fault_.empty()) return fail(Errc::bad_input, fault_);
    return {};
  }

 private:
  std::string_view named_;
  std::string fault_;
};

}  // namespace mjarm::rl::detail
