#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/bench/plan.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/core/pose.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/robot.hpp"

namespace mjarm::app {

/// A robot of the set `near`: whole models in which goals are near things.
struct NearRobot {
  std::string name;            ///< "ur5e, gripper"
  std::filesystem::path file;  ///< its MJCF, in a folder where scenes may be written beside it
  std::string tip;             ///< site of its tool
};

/// The shipped UR5e with a parallel gripper of boxes, the shipped Panda with its hand, and
/// Menagerie's Panda, each copied into a folder of its own in `folder`. Menagerie's is left out,
/// with a warning, where there is no `franka_emika_panda.tar.xz` in `data`, in its `menagerie` or
/// in that of the folder that MJARM_TEST_DATA in the environment names.
[[nodiscard]] Result<std::vector<NearRobot>> near_robots(const std::filesystem::path& data,
                                                         const std::filesystem::path& folder);

/// The kinds of scenes: tables, shelves, cans, boxes, walls.
inline constexpr int kNearKinds = 5;

/// Things round an arm whose base stands on the floor at the origin.
struct NearThings {
  std::string geoms;  ///< MJCF, static geoms of the world
  double level = 0;   ///< [m] above this height nothing is walled in
};
/// Draws the things of a scene.
/// @param kind  0 to kNearKinds - 1.
[[nodiscard]] NearThings draw_near_things(int kind, Rng& rng);
/// What scenes of that kind are called in names of problems: "table".
[[nodiscard]] const char* near_kind_name(int kind);

/// From the arm's home to joint values, or to a pose of the tool.
struct NearProblem {
  std::string id;                 ///< "table 1, 3"
  std::size_t scene = 0;          ///< index into NearSet::scenes
  JointVec start, goal;           ///< (dof,); a pose is met at `goal`
  std::optional<Pose> X_WT = {};  ///< the pose that is asked for
};

/// A robot amid things.
struct NearScene {
  std::filesystem::path file;  ///< MJCF that includes the robot's
  Robot robot;                 ///< read from it
};

/// The problems of one robot.
struct NearSet {
  NearRobot robot;
  std::vector<NearScene> scenes;      ///< those with problems
  std::vector<NearProblem> problems;  ///< scene by scene
};

/// Draws scenes, two of each kind a robot, in which the arm at home is free, and goals in them,
/// `goals` in all for all robots of near_robots(), those left out included. A goal is uniform
/// within the limits, such that by ExactChecker it is free and the nearest thing, which is neither
/// the floor nor the arm itself, is 1 to 20 mm away, and that the links from the third on and the
/// tool are above NearThings::level; each joint is in the turn nearest to the start. Every second
/// one is asked as a pose. The same seed, the same problems.
/// @return impossible where a scene leaves no room.
[[nodiscard]] Result<std::vector<NearSet>> draw_near_sets(const std::vector<NearRobot>& robots,
                                                          int goals, std::uint64_t seed);

/// Judges a path, ours or a peer's: it starts at the start and ends at the goal (to 1e-4 in each
/// joint; a pose to 1e-4 m and 1e-3 rad by MuJoCo's own forward kinematics), stays within the
/// limits (to 1e-4), and at every 0.001 rad (L2) along each edge, ends included, MuJoCo's own
/// collision detection finds nothing.
/// @param exact  of the scene, with a margin of 0.
[[nodiscard]] Result<PathVerdict> judge_near_path(const NearSet& set, const NearProblem& problem,
                                                  ExactChecker& exact,
                                                  std::span<const std::vector<double>> path);

/// Judges the paths of these answers, whose `problem` is an index into NearSet::problems.
[[nodiscard]] Result<void> judge_near_answers(const NearSet& set, std::span<SolvedProblem> answers);

/// Runs the peers on all scenes of a robot, and judges their paths.
/// @return three runs a peer, or one with an error for those it cannot do.
struct NearPeerRuns {
  std::vector<PlanRun> runs;   ///< of joint values, and of poses
  std::vector<PlanRun> first;  ///< first plans
};
[[nodiscard]] Result<NearPeerRuns> run_near_peers(const NearSet& set, const PlanPeers& peers);

/// Solves all problems of a robot, ours and then the peers': PlanningWorld::plan() in one thread in
/// a world that is covered already; and, scene by scene, the first problem once more from nothing:
/// model loaded, covered, planned.
/// @param peers  no environment: ours alone.
[[nodiscard]] Result<PlanTable> run_near_set(const NearSet& set, std::uint64_t seed,
                                             const PlanPeers& peers, Progress& progress);

}  // namespace mjarm::app
