#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/suite.hpp"
#include "mjarm/collision/fast_robot.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/planning/problem_file.hpp"

namespace mjarm::app {

/// The problems of one arm.
struct PlanSet {
  std::string name;            ///< "panda", "ur5"
  std::filesystem::path file;  ///< where they come from; empty where they were made
  Arm arm;
  SphereSet spheres;
  FastRobot robot;                 ///< of both
  std::vector<PlanProblem> cases;  ///< with at least one goal
};

/// Reads `mbm_NAME_public.json.gz`, or `.json`, of a folder: the problems that can be solved.
/// @return not_available where the folder has neither; bad_input where no problem is in it.
[[nodiscard]] Result<PlanSet> load_plan_set(const std::filesystem::path& folder,
                                            const std::string& name);

/// Problems that are much alike.
struct PlanScene {
  std::string name;
  std::vector<std::size_t> problems;  ///< indices into PlanSet::cases
};
/// Scenes in the order of their first problem.
[[nodiscard]] std::vector<PlanScene> scenes_of(const PlanSet& set);

/// The same arm amid more and more of one kind of obstacle.
struct CrowdedSet {
  std::size_t obstacles = 0;  ///< solids, or points of a cloud
  bool points = false;
  PlanSet set;
};

/// Some pairs of random configurations amid 1, 10, 100 and 1000 boxes of 1 to 3 cm, strewn round
/// the arm wherever they leave 3 cm to all of these configurations; then amid 1e3, 1e4 and 1e5
/// points on the sides of those boxes. Fewer boxes are the first ones of more.
[[nodiscard]] Result<std::vector<CrowdedSet>> make_crowded_sets(const PlanSet& like,
                                                                std::uint64_t seed);

/// What is wrong with a path.
enum class PathFault { none, shape, start, goal, limits, obstacle, self };
/// One word for the JSON document: "obstacle"; empty for none.
[[nodiscard]] const char* name_of(PathFault fault);

struct PathVerdict {
  PathFault fault = PathFault::none;
  double depth = 0;  ///< [m] of the deepest overlap
  double cost = 0;   ///< [rad or m] sum of the L2 lengths of the edges
};

/// Judges a path, ours or a peer's, in the plainest way: it starts at the start and ends at a goal
/// (to 1e-4 in each joint), stays within the limits (to 1e-4), and at every 0.005 rad (L2) along
/// each edge, ends included, no sphere overlaps an obstacle or a sphere it is paired with, by any
/// depth. In double precision, one sphere at a time; shares nothing with the planner and its
/// checks but the distance to a solid.
/// @param path  rows of any length; what is no path is a fault.
[[nodiscard]] PathVerdict judge_path(const PlanSet& set, const PlanProblem& problem,
                                     std::span<const std::vector<double>> path);

/// What became of one problem.
struct SolvedProblem {
  std::size_t problem = 0;                     ///< index into PlanSet::cases
  std::vector<std::vector<double>> path = {};  ///< corners; empty: none
  double us = 0;                               ///< [us] from the obstacles to the finished path
  double world_us = 0;                         ///< [us] of it, to take in the obstacles
  PathVerdict verdict = {};
  /// [s] of the motion beside the path within limits of velocity and acceleration, and of that
  /// within limits of the jerk as well; 0: none was made.
  double motion_s = 0, jerk_limited_s = 0;

  [[nodiscard]] bool valid() const { return !path.empty() && verdict.fault == PathFault::none; }
};

/// What one contestant did on some problems of one set.
struct PlanRun : BenchEntry {
  std::vector<SolvedProblem> answers = {};
};

/// Judges the paths of these answers, ours or a peer's, by judge_path(); where there is none, the
/// verdict stays as it is.
void judge_answers(const PlanSet& set, std::span<SolvedProblem> answers);

/// How peers are run.
struct PlanPeers {
  std::filesystem::path environment;  ///< of Python
  int every = 10;                     ///< slow ones solve one problem in so many
  double limit = 10;                  ///< [s] for one problem, and again to shorten its path
};

/// Runs the peers on a scene of a set that comes from a file, and judges their paths. A peer that
/// has a clock of its own inside has two runs.
/// @return one run a peer and clock, see run_peers().
[[nodiscard]] Result<std::vector<PlanRun>> run_plan_peers(const PlanSet& set,
                                                          const PlanScene& scene,
                                                          const PlanPeers& peers);

/// [ns] of one state check, the mean over many states: configurations anywhere within the limits,
/// each with an answer of its own; the same in blocks as wide as a register, asked whether all of
/// a block are free; and 16 along each of many straight edges of 1 rad, each with its answer.
struct CheckTimes {
  double random_ns = 0;
  double together_ns = 0;
  double along_ns = 0;
};

/// All that is shown of one set in one table.
struct PlanTable {
  std::string name = {};              ///< of the set
  std::string file = {};              ///< name of the file it comes from, without its folder
  std::vector<std::string> ids = {};  ///< of its problems; empty: they are counted
  std::vector<PlanRun> runs = {};     ///< ours of a case (`BenchEntry::set`) before those of peers
  bool sum = false;                   ///< adds what each contestant did on all cases together
  std::vector<PlanRun> more = {};     ///< shown after that sum, of which they are no part
  bool complete = false;              ///< it is wrong of mjarm to find no path, too
  bool motions = false;               ///< paths were timed as well
  /// State checks, one a case, in order; of one only: shown where `sum` is.
  std::vector<CheckTimes> checks = {};
};

/// Solves all problems of a set, scene by scene, ours and then the peers', so that a busy machine
/// is so for all of them; and times state checks.
/// @param peers  no environment: ours alone.
[[nodiscard]] Result<PlanTable> run_plan_set(const PlanSet& set, std::uint64_t seed,
                                             const PlanPeers& peers, Progress& progress);

/// Solves all problems of a set with no time to spare, and with 2 and 10 ms for each.
[[nodiscard]] Result<PlanTable> run_anytime(const PlanSet& set, std::uint64_t seed,
                                            Progress& progress);

/// Solves the problems amid each crowd, and times state checks there.
[[nodiscard]] Result<PlanTable> run_crowds(const std::vector<CrowdedSet>& crowds,
                                           std::uint64_t seed, Progress& progress);

/// The table of a set, in which nothing was done yet.
[[nodiscard]] PlanTable table_of(const PlanSet& set);

/// Headings of `BenchEntry::cells`.
/// @param motions  whether any table has them.
[[nodiscard]] std::vector<Msg> plan_columns(bool timing, bool motions);

/// Adds the two cells of motions: how long they take on the mean; and, of a peer, ours over theirs
/// on the problems where both have a valid path and a motion, the mean and the worst, without and
/// with limits of the jerk.
/// @param ours  null: none.
void add_motions(const PlanRun& run, const PlanRun* ours, BenchEntry& entry);

/// The entries of a table and, in `wrong`, how many answers of mjarm are not what was asked for. A
/// peer that fails in the same way on every case is one entry.
[[nodiscard]] BenchResult plan_result(const std::string& name, const PlanTable& table, bool timing,
                                      bool motions);

/// Writes `paths_NAME_WHO.json`, one a contestant, with every path and its time, so that others can
/// judge them: `{"id":{"path":[[q],...],"us":t},...}`.
[[nodiscard]] Result<void> write_paths(const PlanTable& table, bool timing,
                                       const std::filesystem::path& folder);

/// Draws `bench_plan.svg` and `bench_plan.png`: which share of the problems of a set has a valid
/// path within what time, one panel a table of `sets`; and the times of a plan and of a state check
/// over the number of obstacles. Nothing where there is nothing to draw.
/// @param crowds  of `crowded`, one run and one pair of checks each.
[[nodiscard]] Result<void> draw_plan_times(const std::vector<PlanTable>& sets,
                                           const std::vector<CrowdedSet>& crowds,
                                           const PlanTable& crowded,
                                           const std::filesystem::path& folder);

}  // namespace mjarm::app
