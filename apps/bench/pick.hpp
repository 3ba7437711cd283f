#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/program/pick_place.hpp"

namespace mjarm::app {

/// Which of the scenes of a kind are looked at; each has a number, by which it is drawn.
struct SceneNumbers {
  std::uint64_t first = 0;
  int count = 0;

  [[nodiscard]] std::uint64_t number(int i) const { return first + static_cast<std::uint64_t>(i); }
};

/// One object of a scene and where it stands.
struct PlacedObject {
  std::string name;
  Pose X_WB;
};

/// One scene, and what is asked of the arm there.
struct PickProblem {
  std::uint64_t seed = 0;  ///< of the camera's noise
  std::vector<PlacedObject> objects = {};
  program::PickTask task = {};
  int passed_over = 0;  ///< objects that were drawn before `task`, and could not be had at all
};

/// How one problem went, by the simulation's own knowledge.
struct PickVerdict {
  std::string object;
  bool placed = false;       ///< within 5 mm and 5 deg of its place, and nothing is wrong
  double seen_position = 0;  ///< [m] of all objects that had a pose, the worst
  double seen_rotation = 0;  ///< [rad] likewise, up to their symmetry
  double position = 0;       ///< [m] from its place
  double rotation = 0;       ///< [rad] likewise, up to its symmetry
  double others = 0;         ///< [m] farthest that anything else was moved
  std::size_t tries = 0;     ///< grasps that were executed
  double seconds = 0;        ///< [s] simulated
  int passed_over = 0;       ///< PickProblem::passed_over
  std::string miss = {};     ///< why not; empty where all is well
};

/// Scenes of one kind on one robot.
struct PickSet {
  std::string name;
  std::string robot;
  Robot loaded;
  std::function<Result<PickProblem>(std::uint64_t i)> draw;  ///< scene i
};

/// Box, can and house anywhere on the shipped table, standing or lying, each 12 cm from the others;
/// one of them is to be put anywhere into the tray, as it stands or lies, turned at will.
/// @param robot  "ur5e" or "panda".
[[nodiscard]] Result<PickSet> table_scenes(const std::string& robot, std::uint64_t seed);

/// The same with eight objects, half of them so put that they touch another one (0.2 mm) or stand
/// 1 to 6 mm beside it, a beam and a lamp over them. The one that is asked for has a grasp with
/// 1 mm to spare beside the fingers, and a way to its place, where all poses are known; those that
/// have none are counted.
[[nodiscard]] Result<PickSet> clutter_scenes(const std::string& robot, std::uint64_t seed);

/// [rad] between two orientations of one of the objects, up to its symmetry.
[[nodiscard]] double turn_between(const std::string& object, const Eigen::Matrix3d& A,
                                  const Eigen::Matrix3d& B);

[[nodiscard]] inline double in_degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// Looks with the scene's camera, picks and places, in a simulation of its own.
/// @return an error where the camera cannot draw or the simulation broke down.
[[nodiscard]] Result<PickVerdict> solve_pick(const PickSet& set, const PickProblem& problem);

}  // namespace mjarm::app
