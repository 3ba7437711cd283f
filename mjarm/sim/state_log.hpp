#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/sim/sim.hpp"
#include "mjarm/sim/state_columns.hpp"

namespace mjarm {

/// Keeps time, qpos, qvel, ctrl and sensors of any model as it is simulated, in bounded memory:
/// when it is full every second row goes, and from then on half as many are kept. The same run
/// gives the same bytes.
class StateLog {
 public:
  static constexpr std::size_t kMaxRows = 100'000;
  static constexpr std::size_t kMaxNumbers = 8'000'000;  ///< of all rows: 64 MB

  explicit StateLog(const Model& model);

  /// Call before each step and once at the end, with the command that holds from now on, (nu,).
  void record(const Sim& sim, std::span<const double> ctrl);

  [[nodiscard]] const StateColumns& columns() const noexcept { return columns_; }
  /// Rows; the latest is always one of them.
  [[nodiscard]] std::size_t size() const noexcept {
    return numbers_.size() / width_ + (last_.empty() ? 0 : 1);
  }
  /// The numbers of one row: time, then as `columns()`.
  [[nodiscard]] std::span<const double> row(std::size_t i) const {
    const bool kept = (i + 1) * width_ <= numbers_.size();
    return {kept ? numbers_.data() + i * width_ : last_.data(), width_};
  }
  /// Places of the first qpos, qvel, ctrl and sensor in a row.
  [[nodiscard]] std::size_t qpos_at() const noexcept { return 1; }
  [[nodiscard]] std::size_t qvel_at() const noexcept { return qpos_at() + columns_.qpos.size(); }
  [[nodiscard]] std::size_t ctrl_at() const noexcept { return qvel_at() + columns_.qvel.size(); }
  [[nodiscard]] std::size_t sensor_at() const noexcept { return ctrl_at() + columns_.ctrl.size(); }

  /// Header with units and one line a row, full double precision: `time [s],qpos hinge [rad],...`.
  [[nodiscard]] Result<void> write_csv(const std::filesystem::path& file) const;

 private:
  void thin_out();

  StateColumns columns_;
  std::size_t width_;
  std::size_t max_rows_;
  std::size_t calls_ = 0;
  std::size_t stride_ = 1;  ///< calls from row to row
  std::vector<double> numbers_;
  std::vector<double> last_;  ///< the latest row where the stride leaves it out, else empty
};

}  // namespace mjarm
