#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mjarm/collision/cover_robots_test.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm::testing {

/// A robot with what the planner needs, made from a model.
struct CoveredArm {
  CoveredRobot robot;
  ModelCover cover;
  FastChecker checker;
};

inline CoveredArm covered_arm(const char* name) {
  CoveredRobot robot = covered_robot(name);
  ModelCover cover = cover_model(robot.model, robot.arm).value();
  FastChecker checker =
      FastChecker::create(FastRobot::create(robot.arm, cover.spheres).value(), cover.scene).value();
  return {std::move(robot), std::move(cover), std::move(checker)};
}

/// The UR5e with a wall between x > 0 and x < 0.
inline const CoveredArm& walled_arm() {
  static const CoveredArm kArm = covered_arm("universal_robots_ur5e/wall.xml");
  return kArm;
}

/// Looks at the path every 0.005 rad with MuJoCo's exact geometry; the largest tilt met, where
/// there is a limit.
inline double expect_free_exactly(const CoveredArm& arm, const PlannedPath& path,
                                  const std::optional<TiltLimit>& limit = {}) {
  ExactChecker checker(arm.robot.model, arm.robot.arm);
  double largest = 0;
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    const JointVec way = path.q[i] - path.q[i - 1];
    const int samples = std::max(2, static_cast<int>(way.norm() / 0.005));
    for (int k = 0; k <= samples; ++k) {
      const JointVec q = path.q[i - 1] + way * k / samples;
      EXPECT_TRUE(checker.is_free(as_span(q))) << "edge " << i << " at " << k;
      if (limit) largest = std::max(largest, tilt(*limit, arm.robot.arm, as_span(q)));
    }
  }
  return largest;
}

}  // namespace mjarm::testing
