#include <gtest/gtest.h>

#include "mjarm/trajectory/point_to_point_checks_test.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

JointVec vec(const nlohmann::json& numbers) {
  return joint_vec(numbers.get<std::vector<double>>());
}

/// Duration of the slowest joint alone from rest to rest, each by the formulas of the double S
/// (Biagiotti and Melchiorri, section 3.4).
double slowest(const JointVec& way, const JointLimits& limits) {
  double worst = 0;
  for (Eigen::Index i = 0; i < way.size(); ++i) {
    const double h = std::abs(way[i]);
    const double v = limits.velocity[i], a = limits.acceleration[i], j = limits.jerk[i];
    const double jerk_time = std::min(std::sqrt(v / j), a / j);
    const double ramp = v * j < a * a ? 2 * jerk_time : v / a + jerk_time;
    double t = 4 * std::cbrt(h / (2 * j));
    if (h >= v * ramp) {
      t = h / v + ramp;
    } else if (h > 2 * a * a * a / (j * j)) {
      t = a / j + std::sqrt(a * a / (j * j) + 4 * h / a);
    }
    worst = std::max(worst, t);
  }
  return worst;
}

struct DataCase {
  JointState start, end;
  bool rest;
  double best;  // [s] rounded to 9 digits after the point
};

DataCase case_of(const nlohmann::json& entry, const nlohmann::json& best) {
  const auto key = std::to_string(entry.at("id").get<int>());
  return {{vec(entry.at("q0")), vec(entry.at("v0")), vec(entry.at("a0"))},
          {vec(entry.at("q1")), vec(entry.at("v1")), vec(entry.at("a1"))},
          entry.at("kind") == "rest",
          best.at(key).get<double>()};
}

void expect_fastest(const DataCase& c, const JointLimits& limits) {
  constexpr double kRounded = 5.01e-10;
  const auto motion = PointToPoint::solve(c.start, c.end, limits);
  ASSERT_TRUE(motion.has_value());
  EXPECT_LE(motion->duration(), c.best * (1 + 1e-9) + kRounded);
  if (c.rest) {
    const double optimum = slowest(c.end.q - c.start.q, limits);
    EXPECT_NEAR(motion->duration() / optimum, 1, 1e-13);
    EXPECT_NEAR(optimum, c.best, kRounded);
  }
  const testing::Worst worst = testing::worst_of(*motion, c.end, limits);
  EXPECT_LT(std::max({worst.velocity, worst.acceleration, worst.jerk}), 1e-12);
  EXPECT_LT(worst.q, 1e-13);
  EXPECT_LT(worst.v, 1e-12);
  EXPECT_LT(worst.a, 1e-10);
}

void expect_fastest(const std::string& name) {
  MJARM_TEST_FILE(file, "trajectory_cases/" + name + ".json");
  MJARM_TEST_FILE(best_file, "trajectory_cases/best_known.json");
  const nlohmann::json data = support::load_json(file);
  const nlohmann::json best = support::load_json(best_file).at(name).at("p2p_vaj");
  const nlohmann::json& l = data.at("limits");
  const JointLimits limits = testing::limits_of(vec(l.at("v")), vec(l.at("a")), vec(l.at("j")));
  int count = 0, checked = 0;
  for (const auto& entry : data.at("cases")) {
    const DataCase c = case_of(entry, best);
    expect_fastest(c, limits);
    if (++count % 20 != 0) continue;  // sampling takes its time
    const auto trajectory = point_to_point(c.start, c.end, limits);
    ASSERT_TRUE(trajectory.has_value()) << trajectory.error().what;
    const LimitUse use = check_limits(*trajectory, limits);
    EXPECT_LE(std::max(use.worst(), use.jerk.maxCoeff()), 1 + 1e-9);
    ++checked;
  }
  EXPECT_GE(count, 100);
  EXPECT_GE(checked, 5);
}

TEST(PointToPointData, Ur5e) { expect_fastest("ur5e_p2p"); }
TEST(PointToPointData, Panda) { expect_fastest("panda_p2p"); }

}  // namespace
}  // namespace mjarm
