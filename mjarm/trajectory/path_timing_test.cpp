#include "mjarm/trajectory/path_timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/limits_test.hpp"
#include "mjarm/trajectory/spline_internal.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using testing::limits_of;
using testing::plain_limits;
using testing::timed;

using support::kInf;
using support::kNaN;

std::vector<JointVec> random_waypoints(Rng& rng, Eigen::Index dof, std::size_t n) {
  std::vector<JointVec> waypoints{JointVec::Zero(dof)};
  while (waypoints.size() < n) {
    JointVec step(dof);
    for (double& x : step) x = rng.uniform(-1, 1);
    waypoints.emplace_back(waypoints.back() + step * (rng.uniform(0.3, 1.5) / step.norm()));
  }
  return waypoints;
}

/// Worst use of velocity, acceleration and (if asked for) jerk over many samples of every piece,
/// by derivatives of its polynomial written out here.
double worst_use(const Trajectory& motion, const JointLimits& limits, bool with_jerk) {
  double worst = 0;
  for (std::size_t i = 0; i < motion.pieces(); ++i) {
    const Trajectory::Piece p = motion.piece(i);
    for (int k = 0; k <= 10; ++k) {
      const double x = p.duration * k / 10;
      JointVec v = JointVec::Zero(motion.dof()), a = v, j = v;
      for (int m = 1; m < 6; ++m) {
        v += p.c.col(m) * (m * std::pow(x, m - 1));
        if (m > 1) a += p.c.col(m) * (m * (m - 1) * std::pow(x, m - 2));
        if (m > 2) j += p.c.col(m) * (m * (m - 1) * (m - 2) * std::pow(x, m - 3));
      }
      worst = std::max({worst, v.cwiseAbs().cwiseQuotient(limits.velocity).maxCoeff(),
                        a.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff()});
      if (with_jerk) worst = std::max(worst, j.cwiseAbs().cwiseQuotient(limits.jerk).maxCoeff());
    }
  }
  return worst;
}

/// Largest jump of q, v and a between pieces.
double worst_jump(const Trajectory& motion) {
  double worst = 0;
  for (std::size_t i = 0; i + 1 < motion.pieces(); ++i) {
    const Trajectory::Piece p = motion.piece(i), next = motion.piece(i + 1);
    for (int m = 0; m < 3; ++m) {
      JointVec sum = JointVec::Zero(motion.dof());
      for (int k = m; k < 6; ++k) {
        const double binomial = std::tgamma(k + 1) / std::tgamma(m + 1) / std::tgamma(k - m + 1);
        sum += p.c.col(k) * (binomial * std::pow(p.duration, k - m));
      }
      worst = std::max(worst, (sum - next.c.col(m)).cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

detail::CubicSpline spline_of(const std::vector<JointVec>& waypoints) {
  std::vector<double> s{0};
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    s.push_back(s.back() + (waypoints[i] - waypoints[i - 1]).norm());
  }
  return {s, waypoints, detail::SplineEnds::natural};
}

/// Largest distance of samples of `motion` from the path.
double deviation(const Trajectory& motion, const std::vector<JointVec>& waypoints) {
  const detail::CubicSpline spline = spline_of(waypoints);
  double worst = 0, s = 0;
  const int n = 5000;
  for (int i = 0; i <= n; ++i) {
    const JointVec q = motion.at(motion.duration() * i / n).q;
    for (int k = 0; k < 20; ++k) {  // Newton's method for the foot of the perpendicular
      const detail::SplinePoint p = spline.at(s);
      s = std::clamp(s + (q - p.q).dot(p.d) / p.d.squaredNorm(), 0.0, spline.end());
    }
    worst = std::max(worst, (q - spline.at(s).q).norm());
  }
  return worst;
}

TEST(PathTiming, AStraightLineIsBangBang) {
  // Acceleration 5 up to 3 rad/s over 0.9 rad each way; 4 rad in all.
  const JointLimits limits = plain_limits(1);
  const std::vector<JointVec> line{JointVec::Zero(1), JointVec::Constant(1, 4)};
  EXPECT_NEAR(timed(line, limits, false).duration(), 2 * 3. / 5 + (4 - 1.8) / 3, 1e-3);
  // With jerk 100 each change of acceleration takes 0.05 s.
  const double smooth = timed(line, limits, true).duration();
  EXPECT_GT(smooth, 2 * 3. / 5 + (4 - 1.8) / 3 + 0.05 - 1e-3);
  EXPECT_LT(smooth, 1.02 * (2 * 3. / 5 + (4 - 1.8) / 3 + 0.05));
}

TEST(PathTiming, RandomPathsKeepTheirLimitsOnTheirPath) {
  Rng rng(21);
  for (int i = 0; i < 60; ++i) {
    const auto dof = static_cast<Eigen::Index>(1 + rng.below(7));
    const auto waypoints = random_waypoints(rng, dof, 2 + rng.below(12));
    JointVec v(dof), a(dof), j(dof);
    for (Eigen::Index k = 0; k < dof; ++k) {
      v[k] = rng.uniform(0.5, 5);
      a[k] = rng.uniform(1, 20);
      j[k] = std::pow(10, rng.uniform(1, 4));
    }
    const JointLimits limits = limits_of(v, a, j);
    const Trajectory jumps = timed(waypoints, limits, false),
                     smooth = timed(waypoints, limits, true);
    EXPECT_LE(worst_use(jumps, limits, false), 1 + 1e-9) << i;
    EXPECT_LE(worst_use(smooth, limits, true), 1 + 1e-9) << i;
    EXPECT_LT(worst_jump(smooth), 1e-6) << i;
    EXPECT_GE(smooth.duration(), 0.999 * jumps.duration()) << i;
    EXPECT_EQ(jumps.at(0).q, waypoints.front());
    EXPECT_EQ(smooth.at(smooth.duration()).q, waypoints.back());
    EXPECT_EQ(smooth.at(0).a.norm() + smooth.at(smooth.duration()).a.norm(), 0);
    if (dof > 1 && i % 6 == 0) {
      EXPECT_LT(deviation(jumps, waypoints), 1e-6) << i;
      EXPECT_LT(deviation(smooth, waypoints), 1e-6) << i;
    }
  }
}

TEST(PathTiming, UsesALimitAtEveryMoment) {
  // What the fastest motion must do (Pontryagin): somewhere idle means that time is lost.
  Rng rng(22);
  for (int i = 0; i < 20; ++i) {
    const auto waypoints = random_waypoints(rng, 1 + static_cast<Eigen::Index>(rng.below(7)), 6);
    const JointLimits limits = plain_limits(waypoints[0].size());
    const Trajectory motion = timed(waypoints, limits, false);
    int idle = 0;
    const int n = 2000;
    for (int k = 0; k <= n; ++k) {
      const JointState x = motion.at(motion.duration() * k / n);
      const double use = std::max(x.v.cwiseAbs().cwiseQuotient(limits.velocity).maxCoeff(),
                                  x.a.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff());
      idle += use < 0.98 ? 1 : 0;
    }
    EXPECT_LT(idle, n / 50) << i;
  }
}

TEST(PathTiming, MirrorReversalAndScale) {
  Rng rng(23);
  for (int i = 0; i < 10; ++i) {
    const auto waypoints = random_waypoints(rng, 4, 8);
    const JointLimits limits = plain_limits(4);
    for (const bool jerk : {false, true}) {
      const double time = timed(waypoints, limits, jerk).duration();
      std::vector<JointVec> mirrored = waypoints;
      for (JointVec& q : mirrored) q = -q;
      EXPECT_DOUBLE_EQ(timed(mirrored, limits, jerk).duration(), time);
      const std::vector<JointVec> back(waypoints.rbegin(), waypoints.rend());
      EXPECT_NEAR(timed(back, limits, jerk).duration(), time, (jerk ? 1e-2 : 1e-3) * time);
      // Limits for twice the time: half the speed, a quarter, an eighth.
      const JointLimits slow =
          limits_of(limits.velocity / 2, limits.acceleration / 4, limits.jerk / 8);
      EXPECT_NEAR(timed(waypoints, slow, jerk).duration(), 2 * time, (jerk ? 1e-2 : 1e-9) * time);
    }
  }
}

TEST(PathTiming, OddPathsGetAMotionThatKeepsTheLimits) {
  const JointLimits limits = plain_limits(2);
  const auto at = [](double x, double y) { return JointVec(Eigen::Vector2d(x, y)); };
  std::vector<JointVec> circle, repeated, dense;
  for (int i = 0; i <= 100; ++i) {
    circle.push_back(at(std::cos(i * 0.0628318530717), std::sin(i * 0.0628318530717)));
    for (int k = 0; k < 3; ++k) repeated.push_back(circle.back());
  }
  Rng rng(24);
  for (int i = 0; i < 3000; ++i) {
    const double noise = 1e-6 * rng.uniform(-1, 1);
    dense.push_back(at(0.001 * i, std::sin(0.003 * i) + noise));
  }
  const std::vector<std::vector<JointVec>> paths{
      circle,
      repeated,
      dense,
      {at(0, 0), at(1e-9, 0)},
      {at(0, 0), at(1e-6, 1e-7), at(2e-6, 0)},
      {at(0, 0), at(1, 0), at(0, 0)},                         // there and back
      {at(0, 0), at(1, 0), at(1 + 1e-8, 1e-8), at(2, 1)},     // two waypoints nearly the same
      {at(0, 0), at(1000, 0), at(1000.001, 0.001), at(0, 1)}  // long and short steps
  };
  for (const auto& path : paths) {
    for (const bool jerk : {false, true}) {
      const Trajectory motion = timed(path, limits, jerk);
      EXPECT_LE(worst_use(motion, limits, jerk), 1 + 1e-6);
      EXPECT_EQ(motion.at(motion.duration()).q, path.back());
      EXPECT_GT(motion.duration(), 0);
    }
  }
  // Repeated points count once.
  EXPECT_NEAR(timed(repeated, limits, true).duration(), timed(circle, limits, true).duration(),
              1e-9);
}

TEST(PathTiming, NoWayIsARest) {
  const JointLimits limits = plain_limits(2);
  for (const std::size_t n : {1u, 2u, 5u}) {
    const std::vector<JointVec> still(n, JointVec::Ones(2));
    const Trajectory motion = timed(still, limits, true);
    EXPECT_EQ(motion.duration(), 0);
    EXPECT_EQ(motion.at(1).q, still[0]);
  }
}

TEST(PathTiming, SaysWhatIsWrong) {
  const JointVec two = JointVec::Ones(2);
  const auto what = [&](const std::vector<JointVec>& path, const JointLimits& limits) {
    const auto motion = time_waypoint_path(path, limits);
    return motion ? std::string() : motion.error().what;
  };
  const JointLimits limits = plain_limits(2);
  EXPECT_NE(what({}, limits).find("waypoint 0"), std::string::npos);
  EXPECT_NE(what({two, kNaN * two}, limits).find("waypoint 1"), std::string::npos);
  EXPECT_NE(what({two, -two, kInf * two}, limits).find("waypoint 2"), std::string::npos);
  EXPECT_NE(what({two, JointVec::Ones(3)}, limits).find("waypoint 1"), std::string::npos);
  EXPECT_NE(what({two, 1e200 * two}, limits).find("waypoint 1"), std::string::npos);
  EXPECT_NE(what({two, -two}, plain_limits(3)).find("2 joints"), std::string::npos);
  EXPECT_NE(what({two, -two}, limits_of(two, -two, two)).find("2 joints"), std::string::npos);
}

/// All public cases of one file: worst ratio to the optimum without jerk limits.
void expect_cases(const std::string& name, double max, double max_smooth) {
  MJARM_TEST_FILE(file, "trajectory_cases/" + name + ".json");
  MJARM_TEST_FILE(best_file, "trajectory_cases/best_known.json");
  const nlohmann::json data = support::load_json(file);
  const nlohmann::json best = support::load_json(best_file).at(name).at("spline_va");
  const auto vec = [](const nlohmann::json& list) {
    return joint_vec(list.get<std::vector<double>>());
  };
  const nlohmann::json& l = data.at("limits");
  const JointLimits limits = limits_of(vec(l.at("v")), vec(l.at("a")), vec(l.at("j")));
  for (const nlohmann::json& entry : data.at("cases")) {
    std::vector<JointVec> waypoints;
    for (const nlohmann::json& q : entry.at("waypoints")) waypoints.push_back(vec(q));
    const int id = entry.at("id");
    const double optimum = best.at(std::to_string(id));
    for (const bool jerk : {false, true}) {
      const Trajectory motion = timed(waypoints, limits, jerk);
      EXPECT_LE(worst_use(motion, limits, jerk), 1 + 1e-6) << id;
      EXPECT_LE(motion.duration(), (jerk ? max_smooth : max) * optimum) << id;
      EXPECT_GE(motion.duration(), 0.999 * optimum) << id;
    }
  }
}

TEST(PathTimingData, Ur5ePaths) { expect_cases("ur5e_paths", 1.001, 1.05); }
TEST(PathTimingData, PandaPaths) { expect_cases("panda_paths", 1.001, 1.06); }
TEST(PathTimingData, Ur5eEllipse) { expect_cases("ur5e_ellipse", 1.002, 1.04); }

}  // namespace
}  // namespace mjarm
