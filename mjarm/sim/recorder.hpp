#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// What is kept of a simulation. Every default is usable as is.
struct RecordOptions {
  int every = 1;                  ///< steps from row to row, >= 1
  std::size_t max_rows = 100000;  ///< when full, every second row is dropped, >= 2
};

/// One row of a record: what was asked for and what the simulation had, at one time.
struct RecordRow {
  double time = 0;       ///< [s] of the simulation
  JointVec q_ref;        ///< [rad or m] commanded
  JointVec q;            ///< [rad or m] measured
  JointVec v;            ///< [rad/s or m/s] measured
  Pose X_ref;            ///< tool in the world at q_ref
  Pose X_WT;             ///< tool in the world as simulated
  JointVec ctrl;         ///< of the arm's actuators; 0 for a joint that has none
  JointVec torque;       ///< [N m or N] of the arm's drives at the joints, after limits
  std::string contacts;  ///< "geom|geom;geom|geom", all that touches; empty where nothing does
};

/// Keeps what happened in a run, in bounded memory; the same run gives the same bytes.
class Recorder {
 public:
  Recorder(const Model& model, const Arm& arm, const RecordOptions& options = {});
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;

  /// Call once before the first step and once after each; keeps every n-th call.
  /// @param q_ref  where the arm should be now, (dof,).
  void record(const Sim& sim, const JointVec& q_ref);

  [[nodiscard]] std::size_t size() const noexcept;  ///< rows kept
  [[nodiscard]] RecordRow row(std::size_t i) const;

  /// Header with units and one line a row, comma separated, full double precision; poses as x, y, z
  /// and unit quaternion w, x, y, z.
  [[nodiscard]] std::string to_csv() const;
  /// Writes `to_csv()` to a file, in one step.
  [[nodiscard]] Result<void> write_csv(const std::filesystem::path& file) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
