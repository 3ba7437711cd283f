#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/goal_region.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/planning/way_prover.hpp"

namespace mjarm {
namespace detail {
class TimeLeft;
}

/// [m] what WorldOptions::bounds may be.
inline constexpr double kMinSphereBound = 1e-4, kMaxSphereBound = 0.1;
/// [m] the widest WorldOptions::margin.
inline constexpr double kMaxMargin = 0.5;

/// How a robot and its scene are taken. Every default is usable as is.
struct WorldOptions {
  ContactRules rules = {};  ///< what is attached to the tool, what may touch
  /// [m] 0 to kMaxMargin. Every configuration of a path, start and goal included, keeps this
  /// distance between the exact geometry of the moving links (with gripper and attached bodies) and
  /// every obstacle, and twice as much between two of these links. Pairs that may touch by `rules`
  /// or by the model, and pairs that are proved never to meet (ModelCover), are not held to it.
  /// PlanOptions::clearance is what a path keeps beyond that.
  double margin = 0;
  /// (nq,) [rad or m] where joints off the arm stand, those of its gripper as well; empty: keyframe
  /// `home`, else initial values, and all that a gripper can do counts.
  std::vector<double> qpos = {};
  /// [m] kMinSphereBound to kMaxSphereBound: by how much spheres may stick out of the links; each
  /// is tried where the one before may have been what was in the way.
  std::vector<double> bounds = {0.012, 0.003};
};

/// A robot and its scene as the planner takes them, at one bound.
struct WorldLevel {
  double bound = 0;     ///< [m] of WorldOptions::bounds
  ModelCover cover;     ///< its spheres grown by the margin
  FastChecker checker;  ///< of the cover
};

/// A path, and the level that it is proved at.
struct WorldPath : PlannedPath {
  std::size_t level = 0;
};

enum class WorldErrc {
  bad_model,  ///< the model cannot be covered
  no_answer,  ///< no configuration has the tool there
  no_path,    ///< WorldFailure::search says why
};

/// Why there is no path.
struct WorldFailure {
  WorldErrc code = WorldErrc::no_path;
  std::string what;         ///< one line for people, in their language
  PlanFailure search = {};  ///< no_path
  std::size_t level = 0;    ///< no_path: where it was searched last
  /// [m] no_path: by how much spheres stick out there, where that may be what is in the way; 0:
  /// finer ones would be no help.
  double bound = 0;
};

/// Plans paths of one robot in its scene. The model is covered with spheres when a path is asked
/// for first, and again with finer ones when coarse ones may be what is in the way; what was made
/// is kept. The same input gives the same path. Copy it to use it from another
/// thread.
class PlanningWorld {
 public:
  /// Covers nothing yet.
  /// @return bad_input: check_contact_rules()'s error, or one line about the margin or the bounds.
  [[nodiscard]] static Result<PlanningWorld> create(const Robot& robot, WorldOptions options = {});

  /// From `q_start` to one of the goals, by plan_path(): the shortest path of one to all of them
  /// and those to the nearest ones alone; of the clearances of PlanOptions::clearance the links of
  /// ModelCover are held to, as they are to the margin. PlanOptions::time_limit holds for all
  /// searches together; making covers does not count.
  /// @param q_start  shape (dof,) [rad or m].
  /// @param goals    shape (n,), n >= 1, each (dof,).
  /// @param times    where given, the times of all searches are added to it.
  [[nodiscard]] Result<WorldPath, WorldFailure> plan(std::span<const double> q_start,
                                                     std::span<const JointVec> goals,
                                                     const PlanOptions& options = {},
                                                     PlanTimes* times = nullptr);

  /// The same to anywhere in a region of the tool, by goals_in() with the seed and the tilt of
  /// `options`. WorldPath::goal counts the configurations that were found, nearest first.
  /// @param task  what of the pose has to be met.
  [[nodiscard]] Result<WorldPath, WorldFailure> plan(std::span<const double> q_start,
                                                     const GoalRegion& region,
                                                     const PlanOptions& options = {},
                                                     IkTask task = IkTask::pose,
                                                     PlanTimes* times = nullptr);

  /// The same to one pose of the tool in the world.
  [[nodiscard]] Result<WorldPath, WorldFailure> plan(std::span<const double> q_start,
                                                     const Pose& X_WT,
                                                     const PlanOptions& options = {},
                                                     IkTask task = IkTask::pose) {
    return plan(q_start, GoalRegion{.X_WR = X_WT}, options, task);
  }

  /// That of what paths of this world keep together, by the spheres of the finest of their levels.
  /// A way that is to be proved must keep WayProver::kSpare at least.
  /// @param paths  at least one.
  [[nodiscard]] Result<WayProver> prover(std::span<const WorldPath> paths,
                                         const StopCheck& stop = {});

  /// What paths are searched in; stays in place as long as the world does.
  /// @param index  of WorldOptions::bounds. Levels are made in order, when they are asked for.
  /// @param stop   ends the work.
  /// @return cover_model()'s error; bad_input where there is no such level.
  [[nodiscard]] Result<const WorldLevel*> level(std::size_t index, const StopCheck& stop = {});

 private:
  PlanningWorld(const Robot& robot, WorldOptions options)
      : robot_(robot), options_(std::move(options)) {}

  [[nodiscard]] Result<WorldLevel> covered(double bound, const StopCheck& stop) const;
  enum class Ask { preferred, required };
  template <class Attempt>
  [[nodiscard]] Result<WorldPath, WorldFailure> climb(const PlanOptions& options,
                                                      detail::TimeLeft& left, Ask ask,
                                                      const Attempt& attempt);
  template <class Attempt>
  [[nodiscard]] Result<WorldPath, WorldFailure> keep_clearance(const PlanOptions& options,
                                                               const Attempt& attempt);

  Robot robot_;
  WorldOptions options_;
  std::deque<WorldLevel> levels_;                   // as they were needed, coarse ones first
  std::deque<std::map<double, FastChecker>> wide_;  // of each level, by the clearance they keep
};

}  // namespace mjarm
