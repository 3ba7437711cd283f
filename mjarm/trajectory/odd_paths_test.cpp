#include <gtest/gtest.h>

#include <cmath>

#include "mjarm/trajectory/path_timing.hpp"
#include "mjarm/trajectory/via_points.hpp"

namespace mjarm {
namespace {

JointVec at(double x, double y) { return JointVec(Eigen::Vector2d(x, y)); }

/// Closed, dense, tiny, there and back, nearly and wholly equal neighbours.
std::vector<std::vector<JointVec>> odd_paths() {
  std::vector<JointVec> circle, dense;
  for (int i = 0; i <= 100; ++i) {
    circle.push_back(at(std::cos(i * 0.0628318530717), std::sin(i * 0.0628318530717)));
  }
  for (int i = 0; i < 1000; ++i) dense.push_back(at(0.001 * i, std::sin(0.003 * i)));
  return {circle,
          dense,
          {at(0, 0), at(1e-9, 0)},
          {at(0, 0), at(1e-6, 1e-7), at(2e-6, 0)},
          {at(0, 0), at(1, 0), at(0, 0)},
          {at(0, 0), at(1, 0), at(1 + 1e-8, 1e-8), at(2, 1)},
          {at(1, 1), at(1, 1), at(2, 0)}};
}

TEST(OddPaths, GetAMotionOrAReasonFromEveryTimer) {
  const JointVec one = JointVec::Ones(2);
  const JointLimits limits{-99 * one, 99 * one, 3 * one, 5 * one, 100 * one, 8 * one, {}};
  const InverseDynamics dynamics = [](const JointVec& q, const JointVec& v, const JointVec& a) {
    return JointVec(2 * a + v + 2 * q.array().cos().matrix());
  };
  const auto check = [&](const Result<Trajectory>& motion, const JointVec& end) {
    ASSERT_TRUE(motion.has_value()) << motion.error().what;
    const LimitUse use = check_limits(*motion, limits, motion->duration() / 5000.5);
    EXPECT_LE(use.worst(), 1 + 1e-6);
    EXPECT_EQ(motion->at(motion->duration()).q, end);
  };
  for (const auto& path : odd_paths()) {
    SCOPED_TRACE(path.size());
    JointPath tool;
    for (const JointVec& q : path) {
      const double step = tool.q.empty() ? 0 : (q - tool.q.back()).norm();
      tool.s.push_back(tool.s.empty() ? 0 : tool.s.back() + step);
      tool.q.push_back(q);
    }
    if (path[0] == path[1]) {
      const auto motion = time_tool_path(tool, {}, limits);
      ASSERT_FALSE(motion.has_value());
      EXPECT_NE(motion.error().what.find("waypoint 1"), std::string::npos);
    } else {
      check(time_tool_path(tool, {}, limits), path.back());
    }
    for (const bool jerk : {false, true}) {
      const auto motion =
          time_waypoint_path(path, limits, {.jerk_limits = jerk, .dynamics = dynamics});
      check(motion, path.back());
      EXPECT_LE(
          check_torque(*motion, dynamics, limits.torque, motion->duration() / 5000.5).maxCoeff(),
          1.001);
    }
    const auto via = time_via_points(path, limits);
    ASSERT_TRUE(via.has_value()) << via.error().what;
    check(via->trajectory, path.back());
  }
}

}  // namespace
}  // namespace mjarm
