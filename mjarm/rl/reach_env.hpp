#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/rl/reach_options.hpp"
#include "mjarm/rl/vec_env.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::rl {

/// The shipped scene for these options: the Panda on its floor, with a ball where `obstacle` asks
/// for one.
[[nodiscard]] Result<Model> reach_model(const ReachOptions& options = {});

/// An arm that learns to bring its tool to goals. Success does not end an episode: it is cut after
/// `episode_steps`, and the distance at its end is what counts.
///
/// A row of observations, with n joints:
/// | entries | what |
/// |---|---|
/// | n | joint values, -1 at the lower limit and 1 at the upper |
/// | n | joint speeds, 1 = the greatest speed of an action (ReachOptions::speed) |
/// | 3 | tool position p_WT [m] |
/// | 6 | x and y axis of the tool in the world |
/// | 3 | goal in the world [m] |
/// | 3 | e / 0.25 m, with e = goal - tool in the world |
/// | 3 | e / (|e| + 0.02 m) |
/// | 3 | with `orientation`: rotation vector [rad] in the world that turns the tool's z axis down |
/// | 3 | with `obstacle`: middle of the ball - tool [m] in the world |
/// `guide` has observations of its own: guide_options().
///
/// Random numbers of an episode depend on the seed, the number of the copy and the number of the
/// episode alone: row i is the same for any number of copies and threads.
class ReachEnv : public VecEnv {
 public:
  /// Stands at the start as after `reset(0)`.
  /// @return an error for options out of range, a model without an arm or whose joints have no
  ///         actuators, a start that touches something, a region without a goal that can be
  ///         reached.
  [[nodiscard]] static Result<ReachEnv> create(const Model& model,
                                               const ReachOptions& options = {});
  ~ReachEnv() override;
  ReachEnv(ReachEnv&&) noexcept;
  ReachEnv& operator=(ReachEnv&&) noexcept;

  [[nodiscard]] int count() const noexcept override;
  [[nodiscard]] int observation_size() const noexcept override;
  [[nodiscard]] int action_size() const noexcept override;
  [[nodiscard]] Result<void> reset(std::uint64_t seed) override;
  /// The same as copies `first` and up of a larger environment: their goals and starts.
  [[nodiscard]] Result<void> reset(std::uint64_t seed, int first);
  [[nodiscard]] Result<void> step(std::span<const float> actions) override;
  /// The same.
  /// @param stop  asked within the step too; stopped() where it ended it. Nothing but reset() is
  ///              of use then.
  [[nodiscard]] Result<void> step(std::span<const float> actions, const StopCheck& stop);
  [[nodiscard]] std::span<const float> observations() const noexcept override;
  [[nodiscard]] std::span<const float> rewards() const noexcept override;
  [[nodiscard]] std::span<const std::uint8_t> terminated() const noexcept override;
  [[nodiscard]] std::span<const std::uint8_t> truncated() const noexcept override;
  [[nodiscard]] std::span<const float> final_observations() const noexcept override;
  [[nodiscard]] std::vector<double> state() const override;
  [[nodiscard]] Result<void> set_state(std::span<const double> state) override;

  /// [m] (count,) how far the tool was from the goal after the step just done, before any new
  /// episode began.
  [[nodiscard]] std::span<const double> distances() const noexcept;
  /// [m] (count,) the same at the end of the last episode of each copy; NaN before the first end,
  /// and where the simulation failed.
  [[nodiscard]] std::span<const double> final_distances() const noexcept;
  /// [rad] (count,) likewise, the angle of the tool's z axis from straight down; 0 where it is not
  /// part of the task.
  [[nodiscard]] std::span<const double> final_turns() const noexcept;
  /// (count,) 1 where something of the arm touched in the step just done.
  [[nodiscard]] std::span<const std::uint8_t> touching() const noexcept;

  [[nodiscard]] const ReachOptions& options() const noexcept;
  [[nodiscard]] const Model& model() const noexcept;
  [[nodiscard]] const Arm& arm() const noexcept;
  [[nodiscard]] Eigen::Vector3d goal(int copy) const;  ///< [m] in the world
  [[nodiscard]] Pose tool(int copy) const;             ///< X_WT, what is compared with the goal
  [[nodiscard]] Snapshot snapshot(int copy) const;     ///< to draw a copy, or to go on in a Sim

 private:
  struct Impl;
  explicit ReachEnv(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::rl
