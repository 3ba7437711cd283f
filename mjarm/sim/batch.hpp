#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm {

/// Many simulated worlds of one model, stepped together on threads of their own. Each comes out as
/// in a `Sim` of its own, to the last bit, for any number of worlds and threads. Every read after a
/// write is up to date. Calls of one BatchSim must not overlap.
///
/// A world whose simulation fails (NaN, huge values, a fatal error of MuJoCo) is reported by
/// `failed`, keeps nothing of use and is not stepped any more until it is placed anew; the others
/// go on.
class BatchSim {
 public:
  /// All worlds stand in the initial state of the model.
  /// @param count    worlds, 1 to 100000
  /// @param threads  that step them, with the calling one, 1 to 1024
  /// @return an error where numbers are out of range or MuJoCo refuses.
  [[nodiscard]] static Result<BatchSim> create(const Model& model, const Arm& arm, int count,
                                               int threads);
  ~BatchSim();
  BatchSim(BatchSim&&) noexcept;
  BatchSim& operator=(BatchSim&&) noexcept;

  [[nodiscard]] int count() const noexcept;
  [[nodiscard]] const Model& model() const noexcept;
  [[nodiscard]] int mocaps() const noexcept;  ///< mocap bodies of a world

  /// Puts some worlds into the initial state of the model but for what is given here, at rest.
  /// @param worlds  their numbers, rising
  /// @param qpos    (worlds, nq)
  /// @param ctrl    (worlds, nu)
  /// @param mocap   (worlds, 3 nmocap) [m] positions of the mocap bodies in the world; empty: those
  ///                of the model
  void place(std::span<const int> worlds, std::span<const double> qpos,
             std::span<const double> ctrl, std::span<const double> mocap = {});
  /// Advances all worlds that have not failed by `steps` time steps, each with its `ctrl`.
  /// @return how many failed now.
  int step(int steps);

  /// What the next step applies; to be written to.
  [[nodiscard]] std::span<double> ctrl(int world) noexcept;              ///< (nu,)
  [[nodiscard]] std::span<const double> ctrl(int world) const noexcept;  ///< (nu,)
  [[nodiscard]] std::span<const double> qpos(int world) const noexcept;  ///< (nq,)
  [[nodiscard]] std::span<const double> qvel(int world) const noexcept;  ///< (nv,)
  [[nodiscard]] double time(int world) const noexcept;                   ///< [s]
  /// Gravity, Coriolis and centrifugal torque, (nv,) [N m or N].
  [[nodiscard]] std::span<const double> bias(int world) const noexcept;
  [[nodiscard]] Pose tool(int world) const noexcept;  ///< X_WT of the arm's tool frame
  /// Contacts of what the arm moves, with the world or with itself; fingers of the gripper that
  /// touch each other do not count, nor does what overlaps by design.
  [[nodiscard]] int contacts(int world) const noexcept;
  [[nodiscard]] bool failed(int world) const noexcept;
  /// Why it failed, naming time and joint; empty for a world that did not.
  [[nodiscard]] const std::string& error(int world) const noexcept;
  /// As that of a `Sim` of the same model.
  [[nodiscard]] Snapshot snapshot(int world) const;

  /// Everything that decides what comes next, of all worlds, for checkpoints.
  [[nodiscard]] std::vector<double> state() const;
  /// Back to a state of as many worlds of the same model; what follows is the same to the last bit.
  /// @return an error where it does not fit.
  [[nodiscard]] Result<void> set_state(std::span<const double> state);

 private:
  struct Impl;
  explicit BatchSim(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
