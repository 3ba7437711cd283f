#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/point_to_point.hpp"
#include "mjarm/trajectory/point_to_point_checks_test.hpp"
#include "mjarm/trajectory/time_cases.hpp"
#include "mjarm/trajectory/via_points.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using testing::limits_of;

JointVec kept_vec(double x, double y) { return Eigen::Vector2d(x, y); }

/// Worst share of the limits of velocity and acceleration, and how far from the end it stops short
/// of it [rad], as a user sees them: by the trajectory alone.
struct Sampled {
  double velocity = 0, acceleration = 0, jump = 0;
};
Sampled sampled_use(const Trajectory& motion, const JointLimits& limits) {
  Sampled worst;
  JointVec before = motion.at(0).q;
  constexpr int kSamples = 2000;
  const double step = motion.duration() / kSamples;
  for (int i = 0; i <= kSamples; ++i) {
    const JointState x = motion.at(i < kSamples ? i * step : motion.duration());
    worst.velocity =
        std::max(worst.velocity, x.v.cwiseAbs().cwiseQuotient(limits.velocity).maxCoeff());
    worst.acceleration =
        std::max(worst.acceleration, x.a.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff());
    worst.jump = std::max(worst.jump,
                          ((x.q - before).cwiseAbs() - 1.01 * step * limits.velocity).maxCoeff());
    before = x.q;
  }
  return worst;
}

TEST(KeptLimits, HoldForJerkLimitsOfAnySize) {
  const JointState start = JointState::at_rest(kept_vec(0, 0)),
                   end = JointState::at_rest(kept_vec(1, 1));
  for (double jerk = 1e2; jerk < 1e308; jerk *= 31) {
    for (const bool both : {false, true}) {
      const JointLimits limits =
          limits_of(kept_vec(1, 1), kept_vec(5, 5), kept_vec(both ? jerk : 100, jerk));
      const auto motion = point_to_point(start, end, limits);
      ASSERT_TRUE(motion) << jerk << ": " << motion.error().what;
      const Sampled worst = sampled_use(*motion, limits);
      EXPECT_LE(worst.velocity, 1 + 1e-6) << jerk;
      EXPECT_LE(worst.acceleration, 1 + 1e-6) << jerk;
      EXPECT_LE(worst.jump, 1e-9) << jerk;
      // No slower than without any limit of the jerk, but for what is asked of the other joint.
      EXPECT_NEAR(motion->duration(), both ? 1.2 + 5 / jerk : 1.25, 1e-7) << jerk;
    }
  }
}

TEST(KeptLimits, HoldForRandomLimitsWithManyDigitsBetweenThem) {
  Rng rng(24);
  const auto size = [&] { return std::pow(10, rng.uniform(-6, 30)); };
  int moved = 0;
  for (int i = 0; i < 300; ++i) {
    const JointLimits limits =
        limits_of(kept_vec(size(), size()), kept_vec(size(), size()), kept_vec(size(), size()));
    const JointState end = JointState::at_rest(kept_vec(rng.uniform(-3, 3), rng.uniform(-3, 3)));
    const auto motion = point_to_point(JointState::at_rest(kept_vec(0, 0)), end, limits);
    if (!motion) continue;  // said, and not called a motion
    ++moved;
    const Sampled worst = sampled_use(*motion, limits);
    EXPECT_LE(worst.velocity, 1 + 2e-6);
    EXPECT_LE(worst.acceleration, 1 + 2e-6);
  }
  EXPECT_GT(moved, 290);
}

TEST(KeptLimits, HoldThroughWaypointsForAbsurdLimits) {
  const std::vector<JointVec> points{kept_vec(0, 0), kept_vec(1, 0.5), kept_vec(0.2, 1),
                                     kept_vec(2, 2)};
  for (const double jerk : {1e18, 1e100, 1e308}) {
    const JointLimits limits = limits_of(kept_vec(1, 2), kept_vec(5, 8), kept_vec(jerk, 100));
    const auto motion = time_via_points(points, limits);
    ASSERT_TRUE(motion) << motion.error().what;
    const Sampled worst = sampled_use(motion->trajectory, limits);
    EXPECT_LE(worst.velocity, 1 + 2e-6);
    EXPECT_LE(worst.acceleration, 1 + 2e-6);
  }
  const JointVec most = kept_vec(1e308, 1e308);
  const JointLimits absurd = limits_of(most, most, most);
  if (const auto motion = time_via_points(points, absurd)) {
    EXPECT_LE(sampled_use(motion->trajectory, absurd).velocity, 1 + 2e-6);
  }
}

TEST(CheckLimits, CallsNoCorrectMotionBroken) {
  const JointLimits limits =
      limits_of(JointVec::Constant(1, 1), JointVec::Constant(1, 5), JointVec::Constant(1, 20));
  const auto motion = point_to_point(JointState::at_rest(JointVec::Constant(1, 0)),
                                     JointState::at_rest(JointVec::Constant(1, 0.02)), limits);
  ASSERT_TRUE(motion) << motion.error().what;
  // Whatever is left of the duration for the last sample.
  for (int i = 0; i < 2000; ++i) {
    const double dt = motion->duration() / (200 - 0.0005 * i);
    EXPECT_LE(check_limits(*motion, limits, dt).jerk.maxCoeff(), 1 + 1e-6) << i;
  }
}

TEST(CheckLimits, CallsNoPublicCaseBroken) {
  for (const char* name : {"ur5e_p2p.json", "panda_p2p.json"}) {
    MJARM_TEST_FILE(file, "trajectory_cases/" + std::string(name));
    const auto cases = read_time_cases(support::read_data(file), TimeProblem::p2p);
    ASSERT_TRUE(cases) << cases.error().what;
    for (const TimeCase& entry : cases->cases) {
      const auto motion = time_case(entry, cases->limits, TimeProblem::p2p);
      ASSERT_TRUE(motion) << name << " " << entry.id << ": " << motion.error().what;
      const LimitUse use = check_limits(*motion, cases->limits, motion->duration() / 200);
      EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-6) << name << " " << entry.id;
    }
  }
}

}  // namespace
}  // namespace mjarm
