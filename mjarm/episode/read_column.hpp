#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stored_zip.hpp"

namespace mjarm::episode {

/// A column of an episode: one row of numbers a sample.
class NumberRows {
 public:
  NumberRows() = default;
  /// @param values  (rows, width), row by row.
  NumberRows(std::vector<double> values, std::size_t width)
      : values_(std::move(values)), width_(width) {}

  [[nodiscard]] std::size_t rows() const { return width_ == 0 ? 0 : values_.size() / width_; }
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::span<const double> row(std::size_t i) const {
    return std::span(values_).subspan(i * width_, width_);
  }

 private:
  std::vector<double> values_;
  std::size_t width_ = 0;
};

/// Reads a column as `mjarm record` writes it (docs/data.md).
/// @param width   numbers a row, as expected.
/// @param source  name of the archive, for messages.
/// @return bad_input where it is missing or damaged, is another kind of array, or holds a number
///         that is not finite.
[[nodiscard]] Result<NumberRows> read_column(const StoredZip& archive, const std::string& name,
                                             std::size_t width, const std::string& source);

}  // namespace mjarm::episode
