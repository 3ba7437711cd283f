#include "mjarm/execution/path_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/execution/motion_proof_internal.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/slider_test.hpp"
#include "mjarm/trajectory/point_to_point.hpp"

namespace mjarm {
namespace {

JointVec at(double x, double z) { return joint_vec(std::vector{x, z}); }

class PathMotionTest : public ::testing::Test {
 protected:
  PathMotionTest() {
    limits_.velocity = JointVec::Constant(2, 1);
    limits_.acceleration = JointVec::Constant(2, 4);
    limits_.jerk = JointVec::Constant(2, 40);
  }

  PlannedPath planned(const JointVec& from, const JointVec& to, double clearance) {
    return world_.plan(as_span(from), std::vector{to}, {.rounds = 4, .clearance = clearance})
        .value();
  }
  PathMotion timed(const std::vector<JointVec>& corners, std::span<const PlannedPath> paths,
                   const PathMotionOptions& options = {}) {
    return time_path(corners, limits_, world_.prover(paths).value(), options).value();
  }
  /// [m] the least distance by MuJoCo's own geometry, every millisecond.
  double least_clearance(const Trajectory& motion) {
    ExactChecker checker(robot_.model, robot_.arm, {.margin = 1});
    double least = 1;
    for (double t = 0; t <= motion.duration(); t += 1e-3) {
      const auto report = checker.check(as_span(motion.at(t).q)).value();
      if (report.nearest) least = std::min(least, report.nearest->distance);
    }
    return least;
  }
  void expect_limits(const Trajectory& motion) {
    JointLimits limits = robot_.arm.limits;
    limits.velocity = limits_.velocity;
    limits.acceleration = limits_.acceleration;
    limits.jerk = limits_.jerk;
    const LimitUse use = check_limits(motion, limits);
    EXPECT_LE(use.worst(), 1 + 1e-6);
    EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-3);
    EXPECT_LE(use.position.maxCoeff(), 1e-9);
  }
  static bool stops_between(const Trajectory& motion) {
    for (double t = 0.05; t < motion.duration() - 0.05; t += 1e-3) {
      if (motion.at(t).v.cwiseAbs().maxCoeff() < 1e-3) return true;
    }
    return false;
  }

  Robot robot_ = testing::slider(1);
  PlanningWorld world_ = PlanningWorld::create(robot_).value();
  JointLimits limits_ = robot_.arm.limits;
};

TEST_F(PathMotionTest, GoesRoundWithoutAStopAndKeepsTheClearance) {
  for (const double clearance : {0.0, 0.01, 0.05}) {
    const PlannedPath path = planned(at(-0.4, 0.1), at(0.4, 0.1), clearance);
    ASSERT_GT(path.q.size(), 2U);
    const PathMotion motion = timed(path.q, {&path, 1});
    EXPECT_FALSE(stops_between(motion.trajectory)) << clearance;
    EXPECT_LT(motion.trajectory.duration(), 0.8 * motion.stopping);
    EXPECT_GE(least_clearance(motion.trajectory), clearance - 1e-5);
    expect_limits(motion.trajectory);
    EXPECT_LT((motion.trajectory.at(0).q - path.q.front()).norm(), 1e-9);
    EXPECT_LT((motion.trajectory.at(motion.trajectory.duration()).q - path.q.back()).norm(), 1e-9);
  }
}

/// Nothing is in the way: as soon as the slowest joint can be there.
TEST_F(PathMotionTest, AnEdgeTakesNoLongerThanItsSlowestJoint) {
  limits_.acceleration = at(4, 1);
  limits_.velocity = at(0.4, 1);
  limits_.jerk = at(40, 5);
  const PlannedPath path = planned(at(-0.4, 0.3), at(0.4, 0.5), 0.01);
  ASSERT_EQ(path.q.size(), 2U);
  const PathMotion motion = timed(path.q, {&path, 1});
  const auto fastest =
      point_to_point(JointState::at_rest(path.q[0]), JointState::at_rest(path.q[1]), limits_);
  EXPECT_NEAR(motion.trajectory.duration(), fastest->duration(), 1e-9);
  EXPECT_LT(motion.trajectory.duration(), motion.stopping);
  const PathMotion first = timed(path.q, {&path, 1}, {.attempts = 0});
  EXPECT_EQ(first.trajectory.duration(), motion.trajectory.duration());
}

/// Motions between moving states beside the fence, against MuJoCo at every millisecond.
TEST_F(PathMotionTest, ProofsOfMotionsHoldAndMissLittle) {
  constexpr double kClearance = 0.02, kNearly = 1e-3;
  const PlannedPath path = planned(at(-0.4, 0.1), at(0.4, 0.1), kClearance);
  const WayProver prover = world_.prover({&path, 1}).value();
  Rng rng(1, 2);
  const auto random_state = [&](double x) {
    return JointState{at(x, rng.uniform(0.1, 0.3)), at(rng.uniform(-1, 1), rng.uniform(-1, 1)),
                      at(rng.uniform(-3, 3), rng.uniform(-3, 3))};
  };
  int proved = 0, refused = 0;
  for (int k = 0; k < 120; ++k) {
    const auto motion = point_to_point(random_state(rng.uniform(-0.3, -0.06)),
                                       random_state(rng.uniform(-0.3, 0.3)), limits_);
    if (!motion) continue;
    if (detail::is_proved(*motion, prover)) {
      EXPECT_GE(least_clearance(*motion), kClearance - 1e-5);
      ++proved;
    } else {
      EXPECT_LT(least_clearance(*motion), kClearance + kNearly);
      ++refused;
    }
  }
  EXPECT_GT(proved, 20);
  EXPECT_GT(refused, 20);
}

/// Two edges up and down again beside the fence: whatever leaves them to the right touches it.
TEST_F(PathMotionTest, StopsWhereNothingElseIsProved) {
  PlannedPath path = planned(at(-0.4, 0.1), at(-0.05, 0.1), 0);
  path.q = {at(-0.4, 0.1), at(-0.0302, 0.1), at(-0.4, 0.1)};
  const PathMotion motion = timed(path.q, {&path, 1});
  EXPECT_GE(least_clearance(motion.trajectory), 0);
  EXPECT_LE(motion.trajectory.duration(), motion.stopping);
}

/// Also where the velocity is reached before the acceleration, and the jerk limits both.
TEST_F(PathMotionTest, LimitsOfAllKindsHold) {
  Rng rng(1, 3);
  for (int k = 0; k < 12; ++k) {
    limits_.velocity = at(rng.uniform(0.3, 1), rng.uniform(0.3, 1));
    limits_.acceleration = at(rng.uniform(0.5, 8), rng.uniform(0.5, 8));
    limits_.jerk = at(rng.uniform(2, 50), rng.uniform(2, 50));
    const PlannedPath path = planned(at(-0.4, rng.uniform(0.1, 0.2)), at(0.4, 0.1), 0.02);
    const PathMotion motion = timed(path.q, {&path, 1}, {.attempts = 2000});
    EXPECT_LT(motion.trajectory.duration(), motion.stopping);
    expect_limits(motion.trajectory);
  }
}

TEST_F(PathMotionTest, PassesWhatItHasToMeet) {
  const PlannedPath one = planned(at(-0.4, 0.1), at(-0.1, 0.4), 0.01);
  const PlannedPath two = planned(at(-0.1, 0.4), at(0.4, 0.1), 0.01);
  std::vector<JointVec> corners = one.q;
  corners.insert(corners.end(), two.q.begin() + 1, two.q.end());
  const PlannedPath paths[] = {one, two};
  const PathMotion motion = timed(corners, paths, {.passed = {one.q.size() - 1}});
  double nearest = 1;
  for (double t = 0; t < motion.trajectory.duration(); t += 1e-4) {
    nearest = std::min(nearest, (motion.trajectory.at(t).q - at(-0.1, 0.4)).norm());
  }
  EXPECT_LT(nearest, 1.5e-4);
  EXPECT_FALSE(stops_between(motion.trajectory));
  EXPECT_GE(least_clearance(motion.trajectory), 0.01 - 1e-5);
  expect_limits(motion.trajectory);
}

/// It begins 1 mm beside the fence.
TEST_F(PathMotionTest, NearAnEndItKeepsWhatTheEndHas) {
  const PlannedPath path = planned(at(-0.031, 0.1), at(0.4, 0.3), 0.03);
  ASSERT_LT(path.kept.front(), 0.0011);
  const PathMotion motion = timed(path.q, {&path, 1});
  EXPECT_GE(least_clearance(motion.trajectory), path.kept.front() - 1e-6);
  EXPECT_LE(motion.trajectory.duration(), motion.stopping);
}

TEST_F(PathMotionTest, SameMotionEveryTimeAndRestsWhereItIs) {
  const PlannedPath path = planned(at(-0.4, 0.1), at(0.4, 0.1), 0.01);
  const PathMotion a = timed(path.q, {&path, 1}), b = timed(path.q, {&path, 1});
  EXPECT_EQ(a.trajectory.duration(), b.trajectory.duration());
  const double t = 0.4 * a.trajectory.duration();
  EXPECT_EQ(a.trajectory.at(t).q, b.trajectory.at(t).q);
  const PathMotion still = timed({at(0.3, 0.3)}, {&path, 1});
  EXPECT_EQ(still.trajectory.duration(), 0);
  EXPECT_EQ(still.stopping, 0);
}

TEST_F(PathMotionTest, LeadsIntoAStateThatMoves) {
  const PlannedPath path = planned(at(-0.4, 0.1), at(0.4, 0.3), 0.01);
  const Trajectory rest = timed(path.q, {&path, 1}).trajectory;
  const WayProver prover = world_.prover({&path, 1}).value();
  const JointState end{at(0.4, 0.3), at(0.3, -0.2), at(0, 0)};
  const auto moving = lead_into(rest, end, limits_, prover);
  ASSERT_TRUE(moving);
  EXPECT_LT(moving->duration(), rest.duration());
  const JointState last = moving->at(moving->duration());
  EXPECT_LT((last.q - end.q).norm(), 1e-9);
  EXPECT_LT((last.v - end.v).norm(), 1e-9);
  EXPECT_LT((last.a - end.a).norm(), 1e-9);
  EXPECT_GE(least_clearance(*moving), 0.01 - 1e-5);
  expect_limits(*moving);
  // Faster than a joint may be, and back into the fence from beside it.
  EXPECT_FALSE(lead_into(rest, {at(0.4, 0.3), at(1.3, 0), at(0, 0)}, limits_, prover));
  const PlannedPath beside = planned(at(0.4, 0.3), at(0.032, 0.1), 0.001);
  const Trajectory up_to = timed(beside.q, {&beside, 1}).trajectory;
  EXPECT_FALSE(lead_into(up_to, {at(0.032, 0.1), at(0.5, 0), at(0, 0)}, limits_,
                         world_.prover({&beside, 1}).value()));
}

}  // namespace
}  // namespace mjarm
