#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/rl/reach_drive_internal.hpp"
#include "mjarm/rl/reach_options.hpp"
#include "mjarm/sim/batch.hpp"

namespace mjarm::rl {

/// How an episode begins.
struct ReachEpisode {
  JointVec q;            ///< [rad or m] (dof,) the arm's joints, at rest
  Eigen::Vector3d goal;  ///< [m] in the world; each a number that single precision can hold
  Eigen::Vector3d ball;  ///< [m] middle of the obstacle, where the task has one
};

/// Draws the starts and goals of the reach task.
class ReachEpisodes {
 public:
  /// @return an error for a start that does not fit the arm or touches something, a scene without
  ///         the ball that `obstacle` needs, a region without a goal that can be reached.
  [[nodiscard]] static Result<ReachEpisodes> create(const Model& model, const Arm& arm,
                                                    const ReachOptions& options,
                                                    const ReachDrive& drive);

  /// Episode number `episode` of a copy, the same whatever was drawn before.
  [[nodiscard]] ReachEpisode draw(std::uint64_t seed, int copy, std::uint32_t episode);
  /// Whether the region holds this point, reachable or not.
  [[nodiscard]] bool in_region(const Eigen::Vector3d& p_W) const;
  /// Whether inverse kinematics finds a posture there that touches nothing (the ball left out).
  [[nodiscard]] bool reachable(const Eigen::Vector3d& p_W) const;

  /// The whole model at the start of an episode, for BatchSim::place.
  void write(const ReachEpisode& episode, std::span<double> qpos, std::span<double> ctrl) const;

 private:
  struct Probe;
  ReachEpisodes() = default;
  [[nodiscard]] Result<void> find_start(const Arm& arm);
  [[nodiscard]] Result<void> settle(const ReachDrive& drive);
  [[nodiscard]] JointVec draw_start(Rng& rng);
  [[nodiscard]] Eigen::Vector3d draw_goal(Rng& rng) const;
  [[nodiscard]] Eigen::Vector3d draw_ball(Rng& rng, const ReachEpisode& episode) const;

  ReachOptions options_;
  JointVec start_;
  Eigen::Vector3d p_start_ = Eigen::Vector3d::Zero();    ///< [m] the tool at the start
  Eigen::Vector3d some_goal_ = Eigen::Vector3d::Zero();  ///< where no try finds another
  std::shared_ptr<Probe> probe_;  ///< one world in which postures are tried out
  std::shared_ptr<const IkSolver> solver_;
};

}  // namespace mjarm::rl
