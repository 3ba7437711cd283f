#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mjarm::view {

/// A value at a time.
struct TimedValue {
  double time = 0;
  double value = 0;
};

/// Columns of numbers over time in bounded memory. Rows that have to share a place leave their
/// least and greatest value and the times of both, so no peak is ever lost.
class PlotHistory {
 public:
  /// @param columns  numbers a row, > 0.
  /// @param places   >= 2; when all are taken, neighbours are joined.
  /// @param span     [s] > 0: only so much of the latest time is kept, and places are as long as
  ///                 they must be for that; 0: all of it is kept.
  PlotHistory(std::size_t columns, std::size_t places, double span);

  /// @param values  shape (columns,); NaN where there is nothing.
  /// @param time    [s] not before the last one.
  void add(double time, std::span<const double> values);
  void clear();
  [[nodiscard]] std::size_t places() const noexcept { return starts_.size(); }
  /// The column as it was, or its least and greatest values in the order of their times; at most
  /// two a place, rising in time. The last value given is always the last.
  [[nodiscard]] std::vector<TimedValue> column(std::size_t index) const;

 private:
  struct Extremes {
    TimedValue least;
    TimedValue greatest;
  };
  void open_place(double time);
  void join_pairs();
  [[nodiscard]] Extremes* place(std::size_t i) { return &extremes_[i * columns_]; }

  std::size_t columns_;
  std::size_t max_;
  double span_;
  std::size_t rows_a_place_ = 1;
  std::size_t rows_in_last_ = 0;
  std::vector<double> starts_;      ///< [s] of each place
  std::vector<Extremes> extremes_;  ///< (places, columns)
  std::vector<TimedValue> last_;    ///< (columns,)
};

}  // namespace mjarm::view
