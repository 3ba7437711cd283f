#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/collision/edge_check.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/planning/enclosure.hpp"
#include "mjarm/planning/task_region.hpp"
#include "mjarm/planning/tilt_limit.hpp"

namespace mjarm {

/// Which algorithm searches.
enum class Planner {
  rrt_connect,  ///< two trees that grow towards each other (Kuffner and LaValle, ICRA 2000)
  rrt_star,     ///< one tree that is rewired while it grows (Karaman and Frazzoli, IJRR 2011)
  ompl,         ///< PlanOptions::ompl_planner, where OMPL is built in (ompl_planners.hpp)
};

/// [m] the widest PlanOptions::clearance.
inline constexpr double kMaxClearanceAsked = 0.5;
/// [m] what PlanningWorld prefers to keep where nothing is asked.
inline constexpr double kPreferredClearance = 0.005;
/// [rad or m, L2] ends of a path where less than PlanOptions::clearance will do are no longer.
inline constexpr double kFarthestExit = 1;

/// How far a search for a first path is.
struct SearchProgress {
  int samples = 0;  ///< configurations drawn
  /// [rad or m, L2] how near start and goals came to each other; infinite where that is not known.
  double nearest = 0;
};

/// How a path is searched. Every default is usable as is.
struct PlanOptions {
  Planner planner = Planner::rrt_connect;
  std::uint64_t seed = 1;  ///< same problem and seed, same path
  double range = 1;        ///< [rad or m, L2] longest edge that is grown at once, > 0
  /// Budget: configurations that are drawn at most until there is a path, and as many that rrt_star
  /// draws after that; 0: 100,000 (with a clearance 30,000) and 3,000.
  int samples = 0;
  /// [s] >= 0; 0: none. A search that has no path by then ends with PlanErrc::out_of_time, so that
  /// whatever is asked ends; what is found in time does not depend on it.
  double time_limit = 10;
  int shortcuts = 12;        ///< attempts to cut corners of what was found, >= 0
  double resolution = 1e-3;  ///< [rad or m, L2] narrowest interval of the proof of an edge, > 0
  /// More searches, each only for what is shorter than the best path so far, >= 0.
  int rounds = 0;
  /// [s] > 0: as many rounds as there is time for. What is found then depends on the machine.
  double time_budget = 0;
  /// Keeps the tool within a cone, proved for every edge to 1e-8 of the limit. Edges are grown by
  /// 0.3 at most then, and paths have many corners.
  std::optional<TiltLimit> tilt = {};
  /// Keeps the tool within a region (can_be_kept()), proved for every edge to 1e-9 m and rad; steps
  /// as above, shorter where there is little room.
  std::optional<TaskRegion> within = {};
  /// For Planner::ompl: one of ompl_planner_names(); must outlive the options. `samples` count as
  /// above, but planners that go on after their first path draw 10,000 at most until they have it,
  /// and then go on for `time_budget` where one is given. No search takes longer than that, so
  /// there may be no path in time. There are no rounds.
  std::string_view ompl_planner = "RRTConnect";
  /// [m] 0 to kMaxClearanceAsked: what links keep from obstacles and from each other all along a
  /// path. Where start or goal have less, the path begins or ends with an edge, no longer than
  /// kFarthestExit, on which their own clearance is kept (to 0.1 mm). A matter of answer_problem(),
  /// where none is 0, and of PlanningWorld, where none is kPreferredClearance as long as a path is
  /// soon found with it, else 0. plan_path() keeps what its checker was made for.
  std::optional<double> clearance = {};
  /// Asked once, after 2,000 samples without a path (or at the end of fewer), whether there is one
  /// at all; null: is not. Must outlive the search. answer_problem() and PlanningWorld have one of
  /// their own.
  EnclosureTest* enclosure = nullptr;
  /// Called after every few samples until there is a path, so it must be quick.
  std::function<void(const SearchProgress&)> progress = {};
  bool keep_trees = false;  ///< hand over what was searched, to be drawn, say
  StopCheck stop = {};      ///< ends the work with PlanErrc::stopped
};

/// Why there is no path.
enum class PlanErrc {
  bad_input,       ///< no goal, a wrong size, a number that is not finite
  bad_tilt,        ///< PlanOptions::tilt is out of range
  bad_region,      ///< PlanOptions::within cannot be kept
  bad_clearance,   ///< PlanOptions::clearance is out of range
  base_hit,        ///< a link at rest overlaps an obstacle
  start_outside,   ///< the start is outside of the joint limits
  start_hit,       ///< the start is in collision
  goals_outside,   ///< every goal is outside of the joint limits
  goals_hit,       ///< no goal within the limits is free of collisions
  start_tilted,    ///< the tool leans too far at the start
  goals_tilted,    ///< the tool leans too far at every goal that is free of collisions
  start_off,       ///< the tool is outside of PlanOptions::within at the start
  goals_off,       ///< the tool is outside of it at every goal that is free of collisions
  enclosed,        ///< PlanOptions::enclosure proved that there is no path: a ball is shut in
  barred,          ///< it proved the same: a joint cannot pass a value
  budget_spent,    ///< PlanOptions::samples did not do
  out_of_time,     ///< PlanOptions::time_limit did not do
  stopped,         ///< PlanOptions::stop ended the work
  too_near,        ///< no path keeps PlanOptions::clearance, but one with less was found
  unproved,        ///< a path was found, but an edge of it could not be proved (never seen)
  not_available,   ///< OMPL is not built in, or it is and has no PlanOptions::ompl_planner
  tilt_with_ompl,  ///< PlanOptions::tilt and within are for our own planners
  back_end,        ///< OMPL stopped with an error
};

/// Whether that is a proof that there is no path, so that no other search will find one.
[[nodiscard]] constexpr bool is_proof(PlanErrc why) noexcept {
  return why == PlanErrc::enclosed || why == PlanErrc::barred;
}

/// Why there is no path.
struct PlanFailure {
  PlanErrc code = PlanErrc::bad_input;
  SphereClearance pair =
      {};            ///< what overlaps: start_hit, goals_hit (least deep of all goals), base_hit
  int joint = -1;    ///< the first outside of its limits: start_outside, goals_outside
  double value = 0;  ///< [rad or m] where that joint is; start_tilted, goals_tilted: the tilt
  /// [rad] start_tilted, goals_tilted: the largest that is allowed; [m] too_near, bad_clearance:
  /// what was asked; [s] out_of_time: PlanOptions::time_limit.
  double limit = 0;
  double possible = 0;        ///< [m] too_near: the largest clearance for which a path was found
  double nearest = 0;         ///< [rad or m, L2] budget_spent, out_of_time: how near the trees came
  int samples = 0;            ///< drawn
  RegionRoom room = {};       ///< start_off, goals_off: how far outside
  Pocket pocket = {};         ///< enclosed: what proves it
  JointBarrier barrier = {};  ///< barred: likewise
};

/// What a search did.
struct PlanCounts {
  int samples = 0;  ///< configurations drawn
  int nodes = 0;    ///< of all trees; those of OMPL are not counted
  int edges = 0;    ///< edges that were to be proved, those of shortcuts included
};

/// A tree of a search: configurations that are joined by proved edges.
struct SearchTree {
  std::vector<JointVec> q;   ///< nodes, each after the one it was reached from, but for rrt_star
  std::vector<int> parents;  ///< (n,) the node that each was reached from; -1: a root
};

/// A path of straight edges in joint space.
struct RawPath {
  std::vector<JointVec> q;  ///< corners, start and goal included, at least two
  int goal = 0;             ///< index of the goal reached
  PlanCounts counts;
  /// With PlanOptions::keep_trees those of the search that found it: from the start and from the
  /// goals for rrt_connect, from the start for rrt_star.
  std::vector<SearchTree> trees = {};
};

/// A path whose every edge is proved to be free.
struct PlannedPath {
  std::vector<JointVec> q;  ///< corners, start and goal included, at least two
  int goal = 0;             ///< index of the goal reached
  /// Index of the regions that its ends stand for; -1: their configurations were given.
  int start_region = -1, goal_region = -1;
  double cost = 0;                     ///< [rad or m] sum of the L2 lengths of the edges
  std::vector<EdgeCertificate> proof;  ///< one an edge
  double tilt = 0;                     ///< [rad] with a limit: the tool leans by no more anywhere
  RegionRoom room = {};                ///< in PlanOptions::within: no less anywhere
  /// [m] PlanOptions::clearance as it is kept; 0: none was, or none was asked.
  double clearance = 0;
  /// [m] with a clearance: what every configuration of each edge is proved to keep. Less than
  /// `clearance` for the first or the last edge at most.
  std::vector<double> kept = {};
  PlanCounts counts;
  std::vector<SearchTree> trees = {};  ///< as in RawPath
};

/// Searches a path from `start` to any of `goals`. Every edge of it is proved free by check_edge().
/// @param start  shape (dof,) [rad or m].
/// @param goals  shape (n,), n >= 1, each (dof,); those in collision are left out.
[[nodiscard]] Result<RawPath, PlanFailure> find_path(const FastChecker& checker,
                                                     std::span<const double> start,
                                                     std::span<const JointVec> goals,
                                                     const PlanOptions& options = {});

/// Shortens a path of find_path() and proves it again.
/// @return PlanErrc::unproved, where even a much finer resolution proves neither the shortened path
/// nor the one given.
[[nodiscard]] Result<PlannedPath, PlanFailure> finish_path(const FastChecker& checker, RawPath path,
                                                           const PlanOptions& options = {});

/// Searches shorter paths: again and again rrt_connect with other samples, only in the ellipsoid of
/// what can be shorter than `best` (as J. D. Gammell, S. S. Srinivasa and T. D. Barfoot, IROS 2014,
/// and T. S. Wilson et al., AORRTC, 2025), each result and the best one shortened further.
/// @param left_us  [us] of PlanOptions::time_budget that are left; without one, the rounds count.
[[nodiscard]] RawPath improve_path(const FastChecker& checker, std::span<const double> start,
                                   std::span<const JointVec> goals, RawPath best,
                                   const PlanOptions& options, double left_us);

/// How long plan_path() took.
struct PlanTimes {
  double search_us = 0;  ///< [us] find_path() and improve_path()
  double finish_us = 0;  ///< [us] finish_path()
};

/// find_path(), where rounds or a time budget are given improve_path(), and finish_path().
/// @param times  where given, is filled.
[[nodiscard]] Result<PlannedPath, PlanFailure> plan_path(const FastChecker& checker,
                                                         std::span<const double> start,
                                                         std::span<const JointVec> goals,
                                                         const PlanOptions& options = {},
                                                         PlanTimes* times = nullptr);

/// [rad or m] sum of the L2 lengths of the edges.
[[nodiscard]] double path_length(std::span<const JointVec> q) noexcept;

/// One line for people, in their language: why there is no path, with names of links and obstacles.
/// @param obstacles  names of the obstacles by index; missing or empty ones are shown as numbers.
[[nodiscard]] std::string describe(const PlanFailure& failure, const FastRobot& robot,
                                   const Obstacles& obstacles);

}  // namespace mjarm
