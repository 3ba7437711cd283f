#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/program/move_measures_internal.hpp"
#include "mjarm/trajectory/trajectory.hpp"

namespace mjarm::program::detail {

/// A motion round what stands between two configurations.
struct DetourMotion {
  std::vector<JointVec> corners;  ///< both ends included; every edge between them is proved free
  /// From rest to rest. Corners are rounded as far as that is proved free too, else the arm stops.
  Trajectory trajectory;
  MoveMeasures measures;  ///< of the motion, every 5e-3 rad or m of the joint that moves most
  std::size_t goal = 0;   ///< index of the goal reached
};

struct DetourFault {
  std::string reason;  ///< word
  std::string what;    ///< one line for people
};

/// Plans detours of one arm round all that stands in a model.
class DetourPlanner {
 public:
  /// @param ik     whose answers to poses become goals.
  /// @param judge  by which start, goals and motions are checked.
  /// @param world  what is attached, where things stand, and the margin that is kept where a path
  ///               with it can be had.
  /// @param stop   ends the work with the fault `stopped`.
  DetourPlanner(Robot robot, IkSolver ik, MoveJudge judge, WorldOptions world = {},
                StopCheck stop = {})
      : robot_(std::move(robot)),
        ik_(std::move(ik)),
        judge_(std::move(judge)),
        options_(std::move(world)),
        stop_(std::move(stop)) {}

  /// All answers to a pose from `q`, or the fault of the start or of the pose.
  [[nodiscard]] Result<std::vector<JointVec>, DetourFault> goals(const JointVec& q,
                                                                 const Pose& X_WT) const;
  /// `goal` alone, or the fault of the start or of the goal.
  [[nodiscard]] Result<std::vector<JointVec>, DetourFault> goals(const JointVec& q,
                                                                 const JointVec& goal) const;

  /// @param goals  at least one; the motion ends at one of them.
  /// @param share  of the joints' velocity and acceleration limits, (0, 1].
  [[nodiscard]] Result<DetourMotion, DetourFault> plan(const JointVec& q,
                                                       std::span<const JointVec> goals,
                                                       double share);

  /// [m] that is kept where it can be.
  [[nodiscard]] double margin() const { return options_.margin; }

 private:
  [[nodiscard]] Result<DetourMotion, DetourFault> plan_in(std::optional<PlanningWorld>& world,
                                                          const WorldOptions& options,
                                                          const JointVec& q,
                                                          std::span<const JointVec> goals,
                                                          double share);
  [[nodiscard]] std::optional<std::string> touches(const JointVec& q) const;
  /// What touches in the answer to a pose that touches least.
  [[nodiscard]] std::optional<std::string> least_touch(const JointVec& q, const Pose& X_WT) const;
  [[nodiscard]] Result<DetourMotion, DetourFault> timed(const FastChecker& checker,
                                                        const std::vector<JointVec>& path,
                                                        const JointLimits& limits) const;

  Robot robot_;
  IkSolver ik_;
  MoveJudge judge_;
  WorldOptions options_;
  StopCheck stop_;
  std::optional<PlanningWorld> wide_, tight_;  // with and without margin, made when needed
};

}  // namespace mjarm::program::detail
