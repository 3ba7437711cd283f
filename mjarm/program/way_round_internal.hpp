#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/program/move_measures_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::detail {

/// A way round what stands between two configurations, and its timing.
struct WayRound {
  std::vector<JointVec> corners;  ///< both ends included; every edge between them is proved free
  /// From rest to rest. Corners are rounded as far as that is proved free too, else the arm stops.
  Trajectory trajectory;
  MoveMeasures measures;  ///< of the motion, every 5e-3 rad or m of the joint that moves most
  std::size_t goal = 0;   ///< index of the goal reached
};

struct WayRoundFault {
  std::string reason;  ///< word
  std::string what;    ///< one line for people
};

/// Plans ways of one arm round all that stands in a model. The model is covered with spheres when
/// that is needed first; where these are too coarse, again with finer ones.
class WayRoundPlanner {
 public:
  /// @param ik     whose answers to poses become goals.
  /// @param judge  by which start, goals and motions are checked.
  WayRoundPlanner(const Model& model, const Arm& arm, IkSolver ik, MoveJudge judge)
      : model_(model), arm_(arm), ik_(std::move(ik)), judge_(std::move(judge)) {}

  /// All answers to a pose from `q`, or the fault of the start or of the pose.
  [[nodiscard]] Result<std::vector<JointVec>, WayRoundFault> goals(const JointVec& q,
                                                                   const Pose& X_WT) const;
  /// `goal` alone, or the fault of the start or of the goal.
  [[nodiscard]] Result<std::vector<JointVec>, WayRoundFault> goals(const JointVec& q,
                                                                   const JointVec& goal) const;

  /// @param goals  at least one; the way ends at one of them.
  /// @param share  of the joints' velocity and acceleration limits, (0, 1].
  [[nodiscard]] Result<WayRound, WayRoundFault> plan(const JointVec& q,
                                                     std::span<const JointVec> goals, double share);

 private:
  struct World {
    ModelCover cover;
    FastChecker checker;
  };
  [[nodiscard]] Result<World> covered(double bound) const;
  [[nodiscard]] std::optional<std::string> touches(const JointVec& q) const;
  /// What touches in the answer to a pose that touches least.
  [[nodiscard]] std::optional<std::string> least_touch(const JointVec& q, const Pose& X_WT) const;
  [[nodiscard]] Result<WayRound, WayRoundFault> timed(const FastChecker& checker,
                                                      const std::vector<JointVec>& path,
                                                      const JointLimits& limits) const;

  Model model_;
  Arm arm_;
  IkSolver ik_;
  MoveJudge judge_;
  std::vector<World> worlds_;  // as they were needed, coarse ones first
};

}  // namespace mjarm::detail
