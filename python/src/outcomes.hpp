#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mjarm/path/curve.hpp"
#include "mjarm/path/path_fix.hpp"
#include "mjarm/path/path_measures.hpp"
#include "mjarm/planning/planning_world.hpp"

namespace mjarm::python {

/// `mjarm.Path`: what came of a path, whole or not.
struct BoundPath {
  JointPath had = {};  ///< as far as it goes
  int dof = 0;
  std::optional<Curve> curve = {};  ///< that it follows; none: given poses
  std::optional<PathFailure> failure = {};
  std::string what = {};  ///< why it stops
  std::vector<PathFix> fixes = {};
  PathMeasures measures = {};
};

/// `mjarm.Plan`, and what it was planned in.
struct BoundPlan {
  Robot robot;
  PlannedPath path;
  ContactRules rules = {};
  std::shared_ptr<const PlanningWorld> world = {};
};

}  // namespace mjarm::python
