#include "mjarm/trajectory/via_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/limits_test.hpp"
#include "mjarm/trajectory/point_to_point.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using testing::limits_of;

using support::kNaN;
using Waypoints = std::vector<JointVec>;

JointLimits alike(Eigen::Index dof, double v, double a, double j) {
  return limits_of(JointVec::Constant(dof, v), JointVec::Constant(dof, a),
                   JointVec::Constant(dof, j));
}

Waypoints random_waypoints(Rng& rng, int count, Eigen::Index dof, double step) {
  Waypoints points{JointVec::Zero(dof)};
  while (static_cast<int>(points.size()) < count) {
    JointVec q = points.back();
    for (double& x : q) x += rng.uniform(-step, step);
    points.push_back(q);
  }
  return points;
}

double duration_of(const Waypoints& points, const JointLimits& limits) {
  const auto motion = time_via_points(points, limits);
  EXPECT_TRUE(motion.has_value()) << (motion ? "" : motion.error().what);
  return motion ? motion->trajectory.duration() : kNaN;
}

double stopping(const Waypoints& points, const JointLimits& limits) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto move =
        point_to_point(JointState::at_rest(points[i]), JointState::at_rest(points[i + 1]), limits);
    EXPECT_TRUE(move.has_value());
    sum += move ? move->duration() : 0;
  }
  return sum;
}

/// The exact peaks of the velocity, where the acceleration, linear within a phase, crosses zero.
void expect_peaks_within(const Trajectory& x, const JointLimits& limits) {
  const double h = x.duration() / 5000;
  JointState from = x.at(0);
  for (int i = 0; i < 5000; ++i) {
    const JointState to = x.at((i + 1) * h);
    for (int j = 0; j < x.dof(); ++j) {
      if (from.a[j] * to.a[j] >= 0) continue;
      const double t = (i + from.a[j] / (from.a[j] - to.a[j])) * h;
      EXPECT_LE(std::abs(x.at(t).v[j]), limits.velocity[j] * (1 + 1e-6));
    }
    from = to;
  }
}

/// Waypoints met to 1e-9, at ascending times; rest at both ends; q, v and a without jumps and of
/// one motion; all limits kept. Independent of how the motion was made: looks at at(t) only.
void expect_sound(const ViaMotion& motion, const Waypoints& points, const JointLimits& limits) {
  const Trajectory& x = motion.trajectory;
  const double T = x.duration();
  ASSERT_EQ(motion.times.size(), points.size());
  EXPECT_EQ(motion.times.front(), 0);
  EXPECT_EQ(motion.times.back(), T);
  EXPECT_TRUE(std::is_sorted(motion.times.begin(), motion.times.end()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE((x.at(motion.times[i]).q - points[i]).cwiseAbs().maxCoeff(), 1e-9) << i;
  }
  // Just before the end, where the phases lead and not the state that is held from there on.
  const JointState before_end = x.at(std::nextafter(T, 0.0));
  EXPECT_LE((before_end.q - points.back()).cwiseAbs().maxCoeff(), 1e-9);
  for (const JointState& end : {x.at(0), x.at(T), before_end}) {
    EXPECT_LE(end.v.cwiseQuotient(limits.velocity).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LE(end.a.cwiseQuotient(limits.acceleration).cwiseAbs().maxCoeff(), 1e-8);
  }
  // No whole number of samples: over a last one at rounding level the jerk would mean nothing.
  const LimitUse use = check_limits(x, limits, T / 20000.5);
  EXPECT_LE(use.velocity.maxCoeff(), 1 + 1e-6);
  EXPECT_LE(use.acceleration.maxCoeff(), 1 + 1e-6);
  EXPECT_LE(use.jerk.maxCoeff(), 1 + 1e-6);
  expect_peaks_within(x, limits);
  // v and a are the derivatives of q: the error of Simpson's rule on one sample is at rounding
  // level but where a phase ends within it, and there bounded by the jump of the jerk.
  JointState from = x.at(0);
  constexpr int kSteps = 997;
  for (int i = 0; i < kSteps; ++i) {
    const double t = i * T / kSteps, h = T / kSteps;
    const JointState mid = x.at(t + h / 2), to = x.at(t + h);
    const JointVec moved = h / 6 * (from.v + 4 * mid.v + to.v);
    const JointVec sped = h / 6 * (from.a + 4 * mid.a + to.a);
    const JointVec jump = h * h * limits.jerk;
    EXPECT_TRUE(((to.q - from.q - moved).array().abs() <= 0.1 * h * jump.array() + 1e-12).all());
    EXPECT_TRUE(((to.v - from.v - sped).array().abs() <= 0.5 * jump.array() + 1e-12).all());
    from = to;
  }
}

TEST(ViaPoints, KeepsItsPromisesOnRandomWaypoints) {
  Rng rng(1);
  for (int i = 0; i < 150; ++i) {
    const auto dof = static_cast<Eigen::Index>(1 + rng.below(8));
    const double step = std::pow(10, rng.uniform(-6, 0.8));  // from microradians to turns
    Waypoints points = random_waypoints(rng, static_cast<int>(2 + rng.below(14)), dof, step);
    for (std::size_t p = 1; p < points.size(); ++p) {
      if (rng.uniform() < 0.1) points[p] = points[p - 1];
      if (rng.uniform() < 0.1) points[p] = points[p - 1] + 1e-7 * (points[p] - points[p - 1]);
      if (rng.uniform() < 0.2) points[p][0] = points[p - 1][0];
    }
    JointLimits limits = alike(dof, 1, 1, 1);
    for (Eigen::Index j = 0; j < dof; ++j) {
      limits.velocity[j] = std::pow(10, rng.uniform(-1, 1));
      limits.acceleration[j] = std::pow(10, rng.uniform(-1, 2));
      limits.jerk[j] = std::pow(10, rng.uniform(0, 4));
    }
    SCOPED_TRACE(i);
    const auto motion = time_via_points(points, limits);
    ASSERT_TRUE(motion.has_value()) << motion.error().what;
    if (motion->trajectory.duration() > 0) expect_sound(*motion, points, limits);
    EXPECT_LE(motion->trajectory.duration(), stopping(points, limits) * (1 + 1e-12));
  }
}

TEST(ViaPoints, PassesWaypointsOnALineWithoutSlowingDown) {
  // Ten waypoints on the way of one joint: as fast as the move without them, but for the jerk held
  // over whole cells.
  Waypoints points;
  for (int i = 0; i <= 10; ++i) points.push_back(JointVec::Constant(1, 0.4 * i));
  const JointLimits limits = alike(1, 2, 5, 100);
  const double direct = stopping({points.front(), points.back()}, limits);
  const double through = duration_of(points, limits);
  EXPECT_GE(through, direct * (1 - 1e-9));
  EXPECT_LE(through, direct * 1.02);
}

TEST(ViaPoints, IsTheSameMotionBackwardsMirroredAndRescaled) {
  Rng rng(2);
  for (int i = 0; i < 5; ++i) {
    const Waypoints points = random_waypoints(rng, 8, 6, 1);
    const JointLimits limits = alike(6, 3, 5, 100);
    const double T = duration_of(points, limits);
    Waypoints backwards(points.rbegin(), points.rend()), mirrored = points, doubled = points;
    for (JointVec& q : mirrored) q = -q;
    for (JointVec& q : doubled) q *= 2;
    EXPECT_NEAR(duration_of(backwards, limits) / T, 1, 2e-3);
    EXPECT_NEAR(duration_of(mirrored, limits) / T, 1, 1e-6);
    EXPECT_NEAR(duration_of(doubled, alike(6, 6, 10, 200)) / T, 1, 1e-6);
    EXPECT_NEAR(duration_of(points, alike(6, 6, 20, 800)) / T, 0.5, 1e-3);  // twice as fast
    EXPECT_LT(duration_of(points, alike(6, 3, 6, 100)), T);
  }
}

TEST(ViaPoints, SameInputSameBytes) {
  Rng rng(3);
  const Waypoints points = random_waypoints(rng, 10, 7, 1);
  const JointLimits limits = alike(7, 2, 10, 5000);
  const auto one = time_via_points(points, limits), two = time_via_points(points, limits);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->times, two->times);
  const double t = 0.37 * one->trajectory.duration();
  EXPECT_EQ(one->trajectory.at(t).a, two->trajectory.at(t).a);
}

TEST(ViaPoints, TakesOneTwoOrManyWaypoints) {
  Rng rng(4);
  const JointLimits limits = alike(6, 3, 5, 100);
  const Waypoints many = random_waypoints(rng, 600, 6, 0.3);
  for (const std::size_t count : {std::size_t{2}, std::size_t{3}, many.size()}) {
    const Waypoints points(many.begin(), many.begin() + static_cast<std::ptrdiff_t>(count));
    const auto motion = time_via_points(points, limits);
    ASSERT_TRUE(motion.has_value()) << motion.error().what;
    expect_sound(*motion, points, limits);
  }
  const auto still = time_via_points(Waypoints{many[5]}, limits);
  ASSERT_TRUE(still.has_value());
  EXPECT_EQ(still->trajectory.duration(), 0);
  EXPECT_EQ(still->trajectory.at(0).q, many[5]);
}

TEST(ViaPoints, EqualNeighboursAreMetAtOneTime) {
  Rng rng(5);
  const JointLimits limits = alike(3, 3, 5, 100);
  const Waypoints single = random_waypoints(rng, 4, 3, 1);
  Waypoints repeated;
  for (const JointVec& q : single) repeated.insert(repeated.end(), 3, q);
  const auto motion = time_via_points(repeated, limits);
  ASSERT_TRUE(motion.has_value());
  expect_sound(*motion, repeated, limits);
  EXPECT_EQ(motion->trajectory.duration(), duration_of(single, limits));
  EXPECT_EQ(motion->times[3], motion->times[5]);
  EXPECT_EQ(duration_of(Waypoints(5, single[1]), limits), 0);
}

TEST(ViaPoints, NearDuplicatesOnTheWayCostNeitherTimeNorIterations) {
  Rng rng(7);
  const JointLimits limits = alike(6, 3, 5, 100);
  const Waypoints single = random_waypoints(rng, 30, 6, 0.5);
  const auto plain = time_via_points(single, limits);
  ASSERT_TRUE(plain.has_value());
  for (const double gap : {1e-4, 1e-3, 1e-2}) {  // [rad] to the next waypoint, on the fastest way
    SCOPED_TRACE(gap);
    Waypoints pairs;
    for (std::size_t i = 0; i < single.size(); ++i) {
      pairs.push_back(single[i]);
      if (i == 0 || i + 1 == single.size()) continue;
      const double t = plain->times[i], speed = plain->trajectory.at(t).v.norm();
      pairs.push_back(plain->trajectory.at(t + gap / speed).q);
    }
    const auto motion = time_via_points(pairs, limits, {.iterations = 40});
    ASSERT_TRUE(motion.has_value());
    expect_sound(*motion, pairs, limits);
    EXPECT_LE(motion->trajectory.duration(), 1.005 * plain->trajectory.duration());
  }
}

TEST(ViaPoints, NearDuplicatesOffTheWayAreNotStopsEither) {
  // They demand a direction, which costs time, but less than to rest there.
  Rng rng(8);
  const JointLimits limits = alike(6, 3, 5, 100);
  Waypoints pairs;
  for (const JointVec& q : random_waypoints(rng, 20, 6, 0.5)) {
    JointVec offset(6);
    for (double& x : offset) x = rng.uniform(-1, 1);
    pairs.push_back(q);
    pairs.emplace_back(q + offset * (1e-3 / offset.norm()));
  }
  const auto motion = time_via_points(pairs, limits);
  ASSERT_TRUE(motion.has_value());
  expect_sound(*motion, pairs, limits);
  EXPECT_LE(motion->trajectory.duration(), 0.9 * stopping(pairs, limits));
}

TEST(ViaPoints, AnyNumberOfIterationsGivesASoundMotion) {
  Rng rng(6);
  const Waypoints points = random_waypoints(rng, 10, 6, 1);
  const JointLimits limits = alike(6, 3, 5, 100);
  double before = std::numeric_limits<double>::infinity();
  for (const int iterations : {0, 3, 10, 100}) {
    const auto motion = time_via_points(points, limits, {.iterations = iterations});
    ASSERT_TRUE(motion.has_value());
    expect_sound(*motion, points, limits);
    EXPECT_LE(motion->trajectory.duration(), before);
    before = motion->trajectory.duration();
  }
}

TEST(ViaPoints, RefusesWhatMakesNoSense) {
  const JointLimits limits = alike(2, 1, 1, 1);
  const JointVec zero = JointVec::Zero(2), one = JointVec::Ones(2);
  const auto why = [&](const Waypoints& points, const JointLimits& l, const ViaOptions& o = {}) {
    const auto motion = time_via_points(points, l, o);
    return motion ? std::string("no error") : motion.error().what;
  };
  EXPECT_EQ(why({}, limits),
            "waypoints: expected at least one, all finite and of one number of joints; "
            "waypoint 0 (from 0) is not so");
  EXPECT_NE(why({zero, JointVec::Ones(3)}, limits).find("waypoint 1 "), std::string::npos);
  EXPECT_NE(why({zero, one, one * kNaN}, limits).find("waypoint 2 "), std::string::npos);
  EXPECT_NE(why({JointVec(0)}, limits).find("waypoint 0 "), std::string::npos);
  EXPECT_NE(why({zero, one}, alike(3, 1, 1, 1)).find("limits"), std::string::npos);
  EXPECT_NE(why({zero, one}, alike(2, 1, 0, 1)).find("limits"), std::string::npos);
  EXPECT_NE(why({zero, one}, limits, {.iterations = -1}).find("-1"), std::string::npos);
  EXPECT_NE(why({zero, one}, limits, {.joint_share = 0}).find("share"), std::string::npos);
  EXPECT_EQ(why({zero, one}, limits, {.stop = [] { return true; }}), stopped().what);
  // Finite numbers whose differences are not.
  const double huge = std::numeric_limits<double>::max();
  EXPECT_NE(why({-huge * one, huge * one}, limits), "no error");
}

/// Public cases with durations an offline search found; no optima, so shorter ones may exist.
void compare_with_best_known(const std::string& robot, double mean_bound) {
  MJARM_TEST_FILE(cases_file, "trajectory_cases/" + robot + "_paths.json");
  MJARM_TEST_FILE(best_file, "trajectory_cases/best_known.json");
  const nlohmann::json data = support::load_json(cases_file);
  const nlohmann::json best = support::load_json(best_file)[robot + "_paths"]["via_vaj"];
  const auto vec = [](const nlohmann::json& values) {
    return joint_vec(values.get<std::vector<double>>());
  };
  const nlohmann::json& l = data["limits"];
  const JointLimits limits = limits_of(vec(l["v"]), vec(l["a"]), vec(l["j"]));
  double sum = 0;
  for (const nlohmann::json& item : data["cases"]) {
    Waypoints points;
    for (const nlohmann::json& q : item["waypoints"]) points.push_back(vec(q));
    SCOPED_TRACE(item["id"].dump());
    const auto motion = time_via_points(points, limits);
    ASSERT_TRUE(motion.has_value()) << motion.error().what;
    expect_sound(*motion, points, limits);
    const double known = best[item["id"].dump()].get<double>();
    EXPECT_LE(motion->trajectory.duration(), 1.03 * known);
    EXPECT_LT(motion->trajectory.duration(), 0.95 * stopping(points, limits));
    sum += motion->trajectory.duration() / known;
  }
  EXPECT_LE(sum / static_cast<double>(data["cases"].size()), mean_bound);
}

TEST(ViaPoints, MatchesTheBestKnownOfThePanda) { compare_with_best_known("panda", 1.005); }
TEST(ViaPoints, BeatsTheBestKnownOfTheUr5e) { compare_with_best_known("ur5e", 0.94); }

}  // namespace
}  // namespace mjarm
