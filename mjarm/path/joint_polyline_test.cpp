#include "mjarm/path/joint_polyline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

std::vector<JointVec> random_waypoints(Rng& rng, int n, int dof) {
  std::vector<JointVec> waypoints;
  for (int i = 0; i < n; ++i) {
    JointVec q(dof);
    for (double& x : q) x = rng.uniform(-3, 3);
    waypoints.push_back(q);
  }
  return waypoints;
}

double distance_to_leg(const JointVec& q, const JointVec& a, const JointVec& b) {
  const double t = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - q).norm();
}

TEST(JointPolyline, SharpOnesMeetEveryWaypoint) {
  Rng rng(1);
  for (int dof = 1; dof <= kMaxDof; ++dof) {
    const std::vector<JointVec> waypoints = random_waypoints(rng, 2 + dof % 5, dof);
    const JointPolyline line = *joint_polyline(waypoints);
    ASSERT_EQ(line.path.s.size(), line.path.q.size());
    double length = 0;
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      if (i > 0) length += (waypoints[i] - waypoints[i - 1]).norm();
      EXPECT_THAT(line.path.q, ::testing::Contains(waypoints[i]));
    }
    EXPECT_NEAR(line.path.s.back(), length, 1e-12);
    EXPECT_EQ(line.radii, std::vector<double>(waypoints.size() - 2, 0.0));
    if (dof > 1) {
      EXPECT_EQ(line.corners.size(), waypoints.size());
    }
  }
}

TEST(JointPolyline, IsWalkedByItsLengthAndStaysWithinTheBlend) {
  Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    const std::vector<JointVec> waypoints = random_waypoints(rng, 5, 4 + i % 6);
    const JointPolylineOptions options{.blend = rng.uniform(0.05, 4),
                                       .step = rng.uniform(0.002, 0.1)};
    const JointPolyline line = *joint_polyline(waypoints, options);
    const JointPath& path = line.path;
    EXPECT_EQ(path.q.front(), waypoints.front());
    EXPECT_EQ(path.q.back(), waypoints.back());
    EXPECT_THAT(line.corners, ::testing::ElementsAre(0, path.s.back()));
    double away = 0;
    for (std::size_t k = 1; k < path.s.size(); ++k) {
      const double chord = (path.q[k] - path.q[k - 1]).norm(), arc = path.s[k] - path.s[k - 1];
      ASSERT_GT(arc, 0);
      ASSERT_LE(arc, options.step * (1 + 1e-9));
      ASSERT_LE(chord, arc * (1 + 1e-9));
      double nearest = 1e9;
      for (std::size_t w = 1; w < waypoints.size(); ++w) {
        nearest = std::min(nearest, distance_to_leg(path.q[k], waypoints[w - 1], waypoints[w]));
      }
      away = std::max(away, nearest);
    }
    EXPECT_LE(away, *std::max_element(line.radii.begin(), line.radii.end()));
    EXPECT_GT(away, 0);
    for (std::size_t w = 1; w + 1 < waypoints.size(); ++w) {
      const double before = (waypoints[w] - waypoints[w - 1]).norm() * (w == 1 ? 1 : 0.5);
      const double after = (waypoints[w + 1] - waypoints[w]).norm() * (w == 3 ? 1 : 0.5);
      EXPECT_DOUBLE_EQ(line.radii[w - 1], std::min({options.blend, before, after}));
    }
  }
}

TEST(JointPolyline, RoundedCornersTurnStepByStep) {
  const std::vector<JointVec> waypoints{joint_vec(std::vector{0.0, 0.0, 0.0}),
                                        joint_vec(std::vector{1.0, 0.0, 0.0}),
                                        joint_vec(std::vector{1.0, 1.0, 0.5})};
  const auto largest_turn = [&](double blend, double step) {
    const JointPath path = joint_polyline(waypoints, {.blend = blend, .step = step})->path;
    double turn = 0;
    for (std::size_t k = 2; k < path.q.size(); ++k) {
      turn = std::max(turn, ((path.q[k] - path.q[k - 1]).normalized() -
                             (path.q[k - 1] - path.q[k - 2]).normalized())
                                .norm());
    }
    return turn;
  };
  EXPECT_LT(largest_turn(0.3, 0.001), 0.02);
  EXPECT_LT(largest_turn(0.3, 0.0005), 0.01);
  EXPECT_GT(largest_turn(0, 0.001), 1);
}

TEST(JointPolyline, KeepsWhatCannotOrNeedNotBeRounded) {
  const auto q = [](double a, double b) { return joint_vec(std::vector{a, b}); };
  const JointPolyline back =
      *joint_polyline(std::vector{q(0, 0), q(1, 0), q(0, 0)}, {.blend = 0.1});
  EXPECT_THAT(back.corners, ::testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(back.radii, ::testing::ElementsAre(0));
  const JointPolyline straight =
      *joint_polyline(std::vector{q(0, 0), q(1, 0), q(3, 0)}, {.blend = 0.1});
  EXPECT_THAT(straight.corners, ::testing::ElementsAre(0, 3));
}

TEST(JointPolyline, EveryWaypointMayHaveABlendOfItsOwn) {
  const auto q = [](double a, double b) { return joint_vec(std::vector{a, b}); };
  const std::vector corners{q(0, 0), q(1, 0), q(1, 1), q(0, 1)};
  const JointPolyline line = *joint_polyline(corners, {.blend = 0.4, .blends = {0.2, 0}});
  EXPECT_THAT(line.radii, ::testing::ElementsAre(0.2, 0));
  ASSERT_EQ(line.corners.size(), 3U);
}

TEST(JointPolyline, RefusesWhatIsNoPolyline) {
  using ::testing::HasSubstr;
  const auto complaint = [](const std::vector<JointVec>& waypoints,
                            const JointPolylineOptions& options = {}) {
    const auto line = joint_polyline(waypoints, options);
    return line ? std::string("none") : line.error().what;
  };
  using support::kNaN;
  const JointVec a = joint_vec(std::vector{0.0, 1.0}), b = joint_vec(std::vector{1.0, 1.0});
  EXPECT_THAT(complaint({}), HasSubstr("at least 2"));
  EXPECT_THAT(complaint({a}), HasSubstr("at least 2"));
  EXPECT_THAT(complaint({a, b, b}), HasSubstr("1 and 2"));
  EXPECT_THAT(complaint({a, joint_vec(std::vector{1.0})}), HasSubstr("waypoint 1"));
  EXPECT_THAT(complaint({a, joint_vec(std::vector{1.0, kNaN})}), HasSubstr("waypoint 1"));
  EXPECT_THAT(
      complaint({a, joint_vec(std::vector{1e308, -1e308}), joint_vec(std::vector{-1e308, 1e308})}),
      HasSubstr("1"));
  EXPECT_THAT(complaint({a, b}, {.blend = -1}), HasSubstr("blend"));
  EXPECT_THAT(complaint({a, b}, {.blends = {0.1}}), HasSubstr("1 blends"));
  EXPECT_THAT(complaint({a, b}, {.step = 0}), HasSubstr("step"));
  EXPECT_THAT(complaint({a, b}, {.step = 1e-300}), HasSubstr("step"));
  EXPECT_THAT(complaint({a, b}, {.step = kNaN}), HasSubstr("step"));
}

}  // namespace
}  // namespace mjarm
