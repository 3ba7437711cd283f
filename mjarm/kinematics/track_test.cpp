#include "mjarm/kinematics/track.hpp"

#include <gtest/gtest.h>

#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using testing::random_q;

void expect_allowed(const Arm& arm, const JointVec& from, const TrackStep& step,
                    const TrackOptions& options) {
  EXPECT_TRUE(step.ok);
  EXPECT_TRUE(within_limits(arm, as_span(step.q)));
  for (int i = 0; i < arm.dof(); ++i) {
    EXPECT_LE(std::abs(step.q[i] - from[i]), options.dt * arm.limits.velocity[i] * (1 + 1e-12));
  }
}

/// Whatever is asked for, speed and position limits hold; near goals are met.
TEST(Track, LimitsHoldAndGoalsAreMet) {
  Rng rng(91);
  for (const Arm& arm : {testing::ur5e(), testing::panda()}) {
    const TrackOptions options;
    const Tracker tracker(arm, options);
    int met = 0;
    for (int i = 0; i < 300; ++i) {
      JointVec q = random_q(arm, rng);
      const JointVec goal =
          clamp_to_limits(arm, as_span(JointVec(q + 0.1 * (random_q(arm, rng) - q))));
      const Pose X_goal = fk(arm, as_span(goal));
      TrackStep step;
      for (int k = 0; k < 1500; ++k) {
        step = tracker.step(X_goal, as_span(q));
        expect_allowed(arm, q, step, options);
        q = step.q;
      }
      met += step.pos_err < 1e-6 && step.rot_err < 1e-6 ? 1 : 0;
    }
    EXPECT_GT(met, 250);  // some run into a limit or through a singularity
  }
}

/// A goal that moves slowly is followed without lag in a direction that the arm
/// can go.
TEST(Track, FollowsASlowLine) {
  const Arm arm = testing::ur5e();
  const Tracker tracker(arm);
  JointVec q = joint_vec(std::vector<double>{-1.57, -1.34, 2.0, -1.3, 1.55, 0});
  Pose X_goal = fk(arm, as_span(q));
  for (int k = 0; k < 1000; ++k) {
    X_goal.p += Eigen::Vector3d(1e-4, 5e-5, 2e-5);  // 0.057 m/s
    const TrackStep step = tracker.step(X_goal, as_span(q));
    EXPECT_LT(step.pos_err, 3e-4);
    EXPECT_LT((step.q - q).cwiseAbs().maxCoeff(), 2e-3);
    EXPECT_EQ(step.damping, 0);
    q = step.q;
  }
}

/// At a singularity the joints stay slow although the undamped step would be
/// endless.
TEST(Track, IsDampedAtASingularity) {
  const Arm arm = testing::ur5e();
  TrackOptions fast;
  fast.dt = 100;  // so that speed does not limit
  const Tracker tracker(arm, fast);
  const JointVec q = joint_vec(std::vector<double>{0.3, -1.1, 1.2, 0.4, 0, 0.2});
  const FkJacobian at = fk_jacobian(arm, as_span(q));
  EXPECT_LT(smallest_singular_value(at.J_W), 1e-9);
  Rng rng(92);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d way(rng.normal(), rng.normal(), rng.normal());
    Pose X_goal = at.X_WT;
    X_goal.p += 1e-3 * way.normalized();
    X_goal.R = rotation_exp(1e-3 * way) * X_goal.R;
    const TrackStep step = tracker.step(X_goal, as_span(q));
    EXPECT_GT(step.damping, 0.04);
    EXPECT_LT((step.q - q).norm(), 0.1);
  }
}

TEST(Track, AJointAtItsLimitIsHeldAndTheOthersGoOn) {
  Arm arm = testing::panda();
  const Tracker tracker(arm);
  JointVec q = arm.home;
  q[0] = arm.limits.upper[0];
  JointVec beyond = q;
  beyond[0] += 0.2;
  const Pose X_goal = fk(arm, as_span(beyond));
  const double before = (fk(arm, as_span(q)).p - X_goal.p).norm();
  TrackStep step;
  for (int k = 0; k < 500; ++k) {
    step = tracker.step(X_goal, as_span(q));
    EXPECT_LE(step.q[0], arm.limits.upper[0]);
    q = step.q;
  }
  EXPECT_LT(step.pos_err,
            0.5 * before);  // the redundant arm gets there with the other joints
}

TEST(Track, BadInputChangesNothing) {
  const Arm arm = testing::ur5e();
  const Tracker tracker(arm);
  const JointVec q = JointVec::Constant(6, 0.3);
  const Pose X_goal = fk(arm, as_span(q));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Pose bad = X_goal;
  bad.p.x() = nan;
  EXPECT_FALSE(tracker.step(bad, as_span(q)).ok);
  EXPECT_EQ(tracker.step(bad, as_span(q)).q, q);
  bad = X_goal;
  bad.R *= 1.01;
  EXPECT_FALSE(tracker.step(bad, as_span(q)).ok);
  EXPECT_FALSE(tracker.step(X_goal, std::vector<double>(5)).ok);
  EXPECT_FALSE(tracker.step(X_goal, std::vector<double>{0, 0, nan, 0, 0, 0}).ok);
  EXPECT_TRUE(tracker.step(X_goal, as_span(q)).ok);
}

}  // namespace
}  // namespace mjarm
