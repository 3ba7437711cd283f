#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/model/model.hpp"
#include "mjarm/sim/body_poses.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// How a model stood in the course of a run, to be shown again without simulating: a moment every
/// `kInterval` of simulated time, and of a run of more than `kMaxMoments` every second one. It only
/// reads: the simulation goes on as if nobody looked.
class BodyRecord {
 public:
  static constexpr double kInterval = 1.0 / 60;     ///< [s]
  static constexpr std::size_t kMaxMoments = 6000;  ///< 100 s; 50 to 100 of what takes longer

  explicit BodyRecord(const Model& model) : poses_(model) {}

  /// Whether `add` would keep a moment now; spares a snapshot. True where the clock of the
  /// simulation was set back: another run begins, which follows the one before in the record.
  [[nodiscard]] bool is_due(double time) const noexcept;
  /// Keeps a snapshot of the model, whatever its time; one of another model is left out.
  void add(const Snapshot& snapshot);

  [[nodiscard]] std::size_t size() const noexcept { return moments_.size(); }
  [[nodiscard]] bool empty() const noexcept { return moments_.empty(); }
  [[nodiscard]] int bodies() const noexcept { return poses_.size(); }
  [[nodiscard]] double time(std::size_t i) const { return moments_[i].time; }  ///< [s] ascending
  /// [s] of the record, where the clock of the simulation has `time` since the last moment kept.
  [[nodiscard]] double time_at(double time) const noexcept { return offset_ + time; }
  /// shape (nq,)
  [[nodiscard]] std::span<const double> qpos(std::size_t i) const { return moments_[i].qpos; }
  /// [m] shape (3 n,), in the world
  [[nodiscard]] std::span<const double> p_W(std::size_t i) const { return moments_[i].p_W; }
  /// (w, x, y, z), shape (4 n,)
  [[nodiscard]] std::span<const double> quat(std::size_t i) const { return moments_[i].quat; }

 private:
  struct Moment {
    double time;
    std::vector<double> qpos, p_W, quat;
  };

  BodyPoses poses_;
  std::vector<Moment> moments_;
  std::size_t spacing_ = 1;     ///< intervals from one moment to the next
  double offset_ = 0;           ///< [s] of the record at 0 s of the clock
  double next_ = 0;             ///< [s] of the clock, when the next moment is due
  std::optional<double> last_;  ///< [s] of the clock, at the last moment kept
};

}  // namespace mjarm
