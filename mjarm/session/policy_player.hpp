#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {

/// Episodes of a policy, simulation step by simulation step, to be shown: each action is chosen
/// and applied as in training, and a `Sim` goes the same way, to the last bit, in steps that a
/// window can follow.
class PolicyPlayer {
 public:
  /// @param seed  of the first goal; goals that training never sees.
  /// @return an error where the environment cannot be made, or the policy is none for its sizes.
  [[nodiscard]] static Result<PolicyPlayer> create(const Model& model, rl::ReachOptions options,
                                                   rl::Policy policy, std::uint64_t seed);

  /// Begins an episode with the next goal.
  [[nodiscard]] Result<void> begin_episode();
  /// One simulation step. @return false where the episode is over, and nothing was done.
  [[nodiscard]] Result<bool> step();

  [[nodiscard]] Sim& sim() { return sim_; }
  [[nodiscard]] Eigen::Vector3d goal() const { return env_.goal(0); }  ///< [m] in the world
  /// [m] the point that is to reach the goal, as the last action left it.
  [[nodiscard]] Eigen::Vector3d point() const { return env_.tool(0).p; }
  [[nodiscard]] Pose tool() const { return sim_.tool(env_.arm()); }  ///< X_WT
  [[nodiscard]] const Arm& arm() const { return env_.arm(); }

 private:
  PolicyPlayer(const Model& model, rl::ReachEnv env, rl::Policy policy, int actions,
               std::uint64_t seed)
      : env_(std::move(env)),
        policy_(std::move(policy)),
        sim_(model),
        max_actions_(actions),
        seed_(seed) {}
  [[nodiscard]] Result<void> take_action();

  rl::ReachEnv env_;
  rl::Policy policy_;
  Sim sim_;
  int max_actions_;
  std::uint64_t seed_;
  int actions_ = 0;     ///< of this episode
  int steps_left_ = 0;  ///< of the action
  std::vector<double> ctrl_;
  bool ended_ = true;  ///< the task ended the episode by itself
};

}  // namespace mjarm::session
