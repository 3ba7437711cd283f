#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/execution/path_motion.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/program/move_measures_internal.hpp"

namespace mjarm::program::detail {

/// A motion round what stands between two configurations.
struct DetourMotion {
  std::vector<JointVec> corners;  ///< both ends included; every edge between them is proved free
  std::vector<std::size_t> passed = {};  ///< corners where a path ends and the next begins
  PathMotion motion;                     ///< along them
  MoveMeasures measures;  ///< of the motion, every 5e-3 rad or m of the joint that moves most
  std::vector<PlannedPath> paths = {};  ///< one after another; the last ends at the goal reached

  [[nodiscard]] std::size_t goal() const { return static_cast<std::size_t>(paths.back().goal); }
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
  /// @param world   what is attached, and where things stand.
  /// @param stop    ends the work with the fault `stopped`.
  /// @param margin  [m] clearance that is kept where a path with it can be had and none is asked.
  DetourPlanner(Robot robot, IkSolver ik, MoveJudge judge, WorldOptions world = {},
                StopCheck stop = {}, double margin = 0)
      : robot_(std::move(robot)),
        ik_(std::move(ik)),
        judge_(std::move(judge)),
        options_(std::move(world)),
        stop_(std::move(stop)),
        margin_(margin) {}

  /// All answers to a pose from `q`, or the fault of the start or of the pose.
  [[nodiscard]] Result<std::vector<JointVec>, DetourFault> goals(const JointVec& q,
                                                                 const Pose& X_WT) const;
  /// `goal` alone, or the fault of the start or of the goal.
  [[nodiscard]] Result<std::vector<JointVec>, DetourFault> goals(const JointVec& q,
                                                                 const JointVec& goal) const;

  /// @param goals  at least one; the motion ends at one of them.
  /// @param share  of the joints' velocity and acceleration limits, (0, 1].
  /// @param clearance  as in PlanOptions.
  [[nodiscard]] Result<DetourMotion, DetourFault> plan(const JointVec& q,
                                                       std::span<const JointVec> goals,
                                                       double share,
                                                       const std::optional<double>& clearance = {});
  /// One motion along paths of plan() that follow each other, at least one.
  [[nodiscard]] Result<DetourMotion, DetourFault> timed(std::vector<PlannedPath> paths,
                                                        double share);

  /// A motion of timed(), led over into a state that moves instead of to rest.
  /// @return false where that is not free or no faster; then nothing changes.
  [[nodiscard]] bool lead_into(const JointState& end, std::span<const PlannedPath> paths,
                               double share, Trajectory& motion, MoveMeasures& measures);

  /// [m] that is kept where it can be.
  [[nodiscard]] double margin() const { return margin_; }

 private:
  [[nodiscard]] JointLimits limits_at(double share) const;
  [[nodiscard]] Result<PlanningWorld*> world();
  [[nodiscard]] Result<WayProver> prover_of(std::span<const PlannedPath> paths);
  [[nodiscard]] std::optional<std::string> touches(const JointVec& q) const;
  /// What touches in the answer to a pose that touches least.
  [[nodiscard]] std::optional<std::string> least_touch(const JointVec& q, const Pose& X_WT) const;

  Robot robot_;
  IkSolver ik_;
  MoveJudge judge_;
  WorldOptions options_;
  StopCheck stop_;
  double margin_;
  std::optional<PlanningWorld> world_;  // made when it is asked for first
};

}  // namespace mjarm::program::detail
