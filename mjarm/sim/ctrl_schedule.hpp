#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// What some of a model's actuators are commanded with over time: each row holds until the next
/// one, the last for good. Before the first row, and for all other actuators, nothing is said.
class CtrlSchedule {
 public:
  static constexpr std::size_t kMaxValues = 20'000'000;  ///< of a file: rows times actuators

  CtrlSchedule() = default;  ///< says nothing

  /// Commands that hold from the beginning on.
  /// @param values  of actuators by their numbers in the model, from 0.
  /// @return bad_input that names the actuator whose value is no number or beyond its ctrlrange.
  [[nodiscard]] static Result<CtrlSchedule> constant(const Model& model,
                                                     const std::map<int, double>& values);

  /// Reads a table with a header: `time` [s] or `time [s]`, and a column an actuator, `NAME` or
  /// `ctrl NAME`, maybe with a unit in brackets that is not looked at. Times are in seconds from
  /// the start, >= 0, each later than the one before; values as the actuator takes them (rad, m,
  /// N m). What a log.csv has besides (`qpos`, `qvel`, `sensor`) is passed over, so that a log can
  /// be replayed.
  /// @return bad_input with file and line: no such actuator (with the nearest word), not a number,
  ///         beyond the ctrlrange, time that does not grow, more than kMaxValues.
  [[nodiscard]] static Result<CtrlSchedule> read_csv(const Model& model,
                                                     const std::filesystem::path& file);

  /// Writes what holds at `time` [s] from the start into `ctrl`, shape (nu,).
  void apply(double time, std::span<double> ctrl) const;

  /// Numbers of the actuators it speaks of, ascending for `constant`, else in the file's order.
  [[nodiscard]] std::span<const int> actuators() const noexcept { return actuators_; }

 private:
  std::vector<int> actuators_;
  std::vector<double> times_;   ///< [s] ascending
  std::vector<double> values_;  ///< (times, actuators)
};

/// Number of an actuator by its name, or by its number where that has none.
/// @return bad_input with the nearest name and all of them.
[[nodiscard]] Result<int> find_actuator(const Model& model, std::string_view name);

}  // namespace mjarm
