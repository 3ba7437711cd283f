#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
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
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/planning/task_region.hpp"
#include "mjarm/planning/way_prover.hpp"

namespace mjarm {
namespace detail {
class EndConfigurations;
class TimeLeft;
}  // namespace detail

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
  /// (nq,) [rad or m] where joints off the arm stand, those of its gripper as well; empty:
  /// home_configuration().
  std::vector<double> qpos = {};
};

/// A robot and its scene as the planner takes them.
struct WorldScene {
  ModelCover cover;
  FastChecker checker;  ///< of the cover, with the margin; it looks closer
};

/// Where a plan came to nothing.
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
  /// No path to joint values: the same posture in other windings, to which there is one; else
  /// empty.
  JointVec same_posture = {};
};

/// Where a path may begin, or end: at any of some configurations or, where there are regions,
/// anywhere in any of these.
struct PathEnd {
  std::vector<JointVec> q = {};  ///< each (dof,) [rad or m]
  std::vector<TaskRegion> regions = {};
  IkTask task = IkTask::pose;  ///< what of the poses in the regions has to be met
};

/// Plans paths of one robot in its scene. The model is covered with spheres when a path is asked
/// for first; what was made is kept. Paths are searched among spheres alone, and where these may be
/// what is in the way with the exact geometry of what they cannot call free. The same input gives
/// the same path. Copy it to use it from another thread.
class PlanningWorld {
 public:
  /// Covers nothing yet.
  /// @return bad_input: check_contact_rules()'s error, or one line about the margin.
  [[nodiscard]] static Result<PlanningWorld> create(const Robot& robot, WorldOptions options = {});

  /// From `q_start` to one of the goals, by plan_path(): the shortest path of one to all of them
  /// and those to the nearest ones alone; of the clearances of PlanOptions::clearance the links of
  /// ModelCover are held to, as they are to the margin. PlanOptions::time_limit holds for all
  /// searches together; making covers does not count.
  /// @param q_start  shape (dof,) [rad or m].
  /// @param goals    shape (n,), n >= 1, each (dof,).
  /// @param times    where given, the times of all searches are added to it.
  [[nodiscard]] Result<PlannedPath, WorldFailure> plan(std::span<const double> q_start,
                                                       std::span<const JointVec> goals,
                                                       const PlanOptions& options = {},
                                                       PlanTimes* times = nullptr);

  /// The same between two ends, of which each may be regions of the tool: RegionGoals with the seed
  /// and the limits of `options`, starts near Arm::home and goals near the first start. As long as
  /// there is no path, searches have twice the samples of the one before, and more is drawn from
  /// the regions, until PlanOptions::samples are spent. PlannedPath::goal counts the goals that
  /// were drawn, nearest first; then the ends are moved within their regions as long as that makes
  /// the path shorter.
  [[nodiscard]] Result<PlannedPath, WorldFailure> plan(const PathEnd& start, const PathEnd& goal,
                                                       const PlanOptions& options = {},
                                                       PlanTimes* times = nullptr);

  /// The same to one pose of the tool in the world.
  [[nodiscard]] Result<PlannedPath, WorldFailure> plan(std::span<const double> q_start,
                                                       const Pose& X_WT,
                                                       const PlanOptions& options = {},
                                                       IkTask task = IkTask::pose) {
    const bool fits = q_start.size() <= static_cast<std::size_t>(kMaxDof);
    return plan({.q = {fits ? joint_vec(q_start) : JointVec()}},
                {.regions = {region_about(X_WT)}, .task = task}, options);
  }

  /// That of what paths of this world keep together. A way that is to be proved must keep
  /// WayProver::kSpare at least.
  /// @param paths  at least one.
  [[nodiscard]] Result<WayProver> prover(std::span<const PlannedPath> paths,
                                         const StopCheck& stop = {});

  /// What paths are searched in; stays in place as long as the world does. Made when it is asked
  /// for first.
  /// @param stop   ends the work.
  /// @return cover_model()'s error.
  [[nodiscard]] Result<const WorldScene*> scene(const StopCheck& stop = {});

 private:
  void tell_winding(std::span<const double> q_start, const JointVec& goal,
                    const PlanOptions& options, WorldFailure& why);
  [[nodiscard]] PlanOptions testing(std::optional<EnclosureTest>& test,
                                    std::span<const double> q_start,
                                    std::span<const JointVec> goals,
                                    const PlanOptions& options) const;
  PlanningWorld(const Robot& robot, WorldOptions options)
      : robot_(robot), options_(std::move(options)) {}

  [[nodiscard]] Result<detail::EndConfigurations, WorldFailure> configurations(
      const PathEnd& end, std::span<const double> q_near, const PlanOptions& options) const;
  [[nodiscard]] Result<WorldScene> covered(const StopCheck& stop) const;
  template <class Attempt>
  [[nodiscard]] Result<PlannedPath, WorldFailure> spheres_then_solids(const PlanOptions& options,
                                                                      detail::TimeLeft& left,
                                                                      const Attempt& attempt);
  template <class Attempt>
  [[nodiscard]] Result<PlannedPath, WorldFailure> keep_clearance(const PlanOptions& options,
                                                                 const Attempt& attempt);

  Robot robot_;
  WorldOptions options_;
  std::shared_ptr<const WorldScene> scene_;
  /// Checkers that keep a clearance, by that: spheres alone, and looking closer.
  std::map<double, FastChecker> wide_spheres_, wide_;
};

}  // namespace mjarm
