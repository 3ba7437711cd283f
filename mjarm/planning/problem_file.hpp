#pragma once

#include <string>
#include <vector>

#include "mjarm/collision/obstacles.hpp"
#include "mjarm/collision/sphere_set.hpp"
#include "mjarm/core/joint_vec.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm {

/// A path to be found.
struct PlanProblem {
  std::string id;
  std::string scene;            ///< kind of scene, for tables; may be empty
  std::vector<double> start;    ///< shape (dof,) [rad or m]
  std::vector<JointVec> goals;  ///< (n,) each of shape (dof,); may be empty
  Obstacles obstacles;
  bool valid = true;  ///< what the file says: start and some goal are free
};

/// A robot as joints and spheres, and problems for it.
struct ProblemFile {
  Arm arm;
  SphereSet spheres;
  std::vector<PlanProblem> problems;
};

/// How cylinders of a file are taken.
enum class Cylinders {
  replaced,  ///< by what their member `vamp_as` names, box or capsule, where there is one
  exact,     ///< as they are
};

/// Reads a JSON file of problems, plain or gzipped: `robot` (joints, spheres, pairs of links that
/// must not overlap) and `problems` (id, start, goals, obstacles).
/// @return an error that names the file and the element.
[[nodiscard]] Result<ProblemFile> read_problem_file(const std::string& path,
                                                    Cylinders cylinders = Cylinders::replaced);

}  // namespace mjarm
