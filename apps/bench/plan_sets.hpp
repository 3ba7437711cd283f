#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mjarm/collision/fast_robot.hpp"
#include "mjarm/core/result.hpp"
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

/// Scenes in the order of their first problem.
[[nodiscard]] std::vector<std::string> scenes_of(const PlanSet& set);

/// Indices of the problems of a scene.
[[nodiscard]] std::vector<std::size_t> cases_of(const PlanSet& set, const std::string& scene);

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

}  // namespace mjarm::app
