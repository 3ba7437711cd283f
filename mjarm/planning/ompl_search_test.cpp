#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>

#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/planning/plan_path.hpp"

namespace mjarm {
namespace {

using testing::goal_at;
using testing::goals_at;

/// Two links of 0.5 m that turn about z, the first without stops, and posts in their way.
struct PostWorld {
  Arm arm = testing::make_arm("flat",
                              {{{0, 0, 0}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), -1e9, 1e9},
                               {{0.5, 0, 0}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), -2.8, 2.8}},
                              {{0.5, 0, 0}, Eigen::Matrix3d::Identity()});
  SphereSet spheres;
  Obstacles world;

  PostWorld() {
    for (int joint = 0; joint < 2; ++joint) {
      spheres.links.push_back({joint == 0 ? "upper" : "lower", joint, {}});
      for (int k = 1; k <= 10; ++k) {
        spheres.links.back().spheres.push_back({{0.05 * k, 0, 0}, 0.04});
      }
    }
    add_post(0.7, 0, 0.05);
  }
  void add_post(double x, double y, double radius) {
    world.solids.push_back(
        {"post", {{x, y, 0}, Eigen::Matrix3d::Identity()}, CapsuleShape{radius, 0.3}});
  }
  FastChecker checker() const {
    return FastChecker::create(FastRobot::create(arm, spheres).value(), world).value();
  }
};

constexpr std::array<double, 2> kHere{0.8, 0}, kThere{-0.8, 0};

PlanOptions ompl_options(std::string_view planner, int samples) {
  PlanOptions options;
  options.planner = Planner::ompl;
  options.ompl_planner = planner;
  options.samples = samples;
  return options;
}

std::vector<double> numbers_of(const Result<RawPath, PlanFailure>& path) {
  std::vector<double> out;
  if (!path) return out;
  for (const JointVec& q : path->q) out.insert(out.end(), q.begin(), q.end());
  return out;
}

/// Looks at many places of the path with plain double-precision code.
void expect_clear(const FastChecker& checker, const Obstacles& world,
                  const std::vector<JointVec>& path) {
  const FastRobot& robot = checker.robot();
  ASSERT_GE(path.size(), 2u);
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_EQ(check_edge(checker, as_span(path[i - 1]), as_span(path[i])).verdict,
              EdgeVerdict::free);
    const JointVec way = path[i] - path[i - 1];
    const int parts = std::max(2, static_cast<int>(way.norm() / 0.01));
    for (int k = 0; k <= parts; ++k) {
      const JointVec q = path[i - 1] + way * k / parts;
      EXPECT_GT(testing::true_clearance(robot.arm(), robot.spheres(), world, as_span(q)), 0);
    }
  }
}

/// Skips where OMPL is not built in.
class Ompl : public ::testing::Test {
 protected:
  void SetUp() override {
    if (ompl_version().empty()) GTEST_SKIP() << "built without OMPL (libompl-dev)";
  }
};

class OmplPlanner : public Ompl, public ::testing::WithParamInterface<std::string> {};

TEST_P(OmplPlanner, GoesRoundAPostToTheGoalThatCanBeReached) {
  const PostWorld flat;
  const FastChecker checker = flat.checker();
  ASSERT_EQ(check_edge(checker, kHere, kThere).verdict, EdgeVerdict::hit);
  const auto goals =
      goals_at({{0, 0}, {0, 5}, {-0.8, 0}});  // in collision, outside, behind the post
  const PlanOptions options = ompl_options(GetParam(), 1000);
  const auto raw = find_path(checker, kHere, goals, options);
  ASSERT_TRUE(raw) << describe(raw.error(), checker.robot(), flat.world);
  EXPECT_EQ(raw->q.front(), joint_vec(kHere));
  EXPECT_EQ(raw->q.back(), joint_vec(kThere));
  EXPECT_EQ(raw->goal, 2);
  EXPECT_GT(raw->counts.samples, 0);
  EXPECT_GT(raw->counts.edges, 0);
  expect_clear(checker, flat.world, raw->q);
  const auto path = finish_path(checker, *raw, options);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->proof.size() + 1, path->q.size());
  EXPECT_LE(path->cost, path_length(raw->q) + 1e-12);
  expect_clear(checker, flat.world, path->q);
}

TEST_P(OmplPlanner, SameBytesWhateverElseRuns) {
  const PostWorld flat;
  const FastChecker checker = flat.checker();
  const auto goals = goals_at({{-0.8, 0}, {-0.8, 1}, {-2.4, -0.5}});
  const PlanOptions options = ompl_options(GetParam(), 700);
  const auto search = [&] { return numbers_of(find_path(checker, kHere, goals, options)); };
  const std::vector<double> alone = search();
  ASSERT_FALSE(alone.empty());
  // The generator of seeds of the whole process has moved on.
  EXPECT_EQ(search(), alone);
  std::array<std::vector<double>, 3> together;
  {
    std::vector<std::jthread> threads;
    for (auto& out : together) threads.emplace_back([&] { out = search(); });
    threads.emplace_back([&] {  // others
      for (const std::string& name : ompl_planner_names()) {
        (void)find_path(checker, kThere, goal_at(kHere), ompl_options(name, 200));
      }
    });
  }
  for (const auto& out : together) EXPECT_EQ(out, alone);
}

TEST_P(OmplPlanner, SeedsDiffer) {
  const PostWorld flat;
  const FastChecker checker = flat.checker();
  PlanOptions options = ompl_options(GetParam(), 700);
  const auto one = numbers_of(find_path(checker, kHere, goal_at(kThere), options));
  options.seed = 2;
  EXPECT_NE(numbers_of(find_path(checker, kHere, goal_at(kThere), options)), one);
}

TEST_P(OmplPlanner, AGoalWalledInSpendsTheBudget) {
  PostWorld flat;
  flat.world = {};
  for (const double angle : {-1.1, -0.5}) {
    flat.add_post(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.03);
  }
  const FastChecker checker = flat.checker();
  ASSERT_TRUE(checker.is_free(kThere));
  const auto path = plan_path(checker, kHere, goal_at(kThere), ompl_options(GetParam(), 1200));
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, PlanErrc::budget_spent);
  EXPECT_LE(path.error().samples, 1200 + 1000);  // some draw in batches
  EXPECT_GT(path.error().nearest, 0.1);
  EXPECT_LE(path.error().nearest, 1.6);
}

TEST_P(OmplPlanner, EveryPathInRandomWorldsIsFree) {
  Rng rng(11);
  int planned = 0, bent = 0;
  for (int round = 0; round < testing::rounds(25, 1000); ++round) {
    const Arm arm = testing::random_arm(2 + static_cast<int>(rng.below(6)), rng);
    const SphereSet set = testing::random_spheres(arm, rng);
    const Obstacles world = testing::random_world(rng, 6);
    const auto robot = FastRobot::create(arm, set);
    if (!robot) continue;
    const FastChecker checker = FastChecker::create(*robot, world).value();
    const JointVec start = testing::random_q(arm, rng), goal = testing::random_q(arm, rng);
    PlanOptions options = ompl_options(GetParam(), 400);
    options.seed = static_cast<std::uint64_t>(round);
    const auto path = plan_path(checker, as_span(start), goal_at(as_span(goal)), options);
    if (!path) {
      EXPECT_NE(path.error().code, PlanErrc::unproved);
      EXPECT_NE(path.error().code, PlanErrc::back_end);
      EXPECT_NE(path.error().code, PlanErrc::not_available);
      continue;
    }
    ++planned;
    bent += path->q.size() > 2 ? 1 : 0;
    expect_clear(checker, world, path->q);
  }
  EXPECT_GT(planned, 3);
  EXPECT_GT(bent, 0);
}

INSTANTIATE_TEST_SUITE_P(Planners, OmplPlanner, ::testing::ValuesIn(ompl_planner_names()),
                         [](const auto& param) { return param.param; });

TEST_F(Ompl, FailuresAreThoseOfThePlannersHere) {
  const PostWorld flat;
  const FastChecker checker = flat.checker();
  const std::array<double, 2> inside{0, 0}, beyond{0, 3.5};
  const auto reason = [&](std::span<const double> start, const std::vector<JointVec>& goals) {
    const auto path = plan_path(checker, start, goals, ompl_options("RRTConnect", 100));
    return path ? PlanErrc::unproved : path.error().code;
  };
  EXPECT_EQ(reason(inside, goal_at(kThere)), PlanErrc::start_hit);
  EXPECT_EQ(reason(beyond, goal_at(kThere)), PlanErrc::start_outside);
  EXPECT_EQ(reason(kHere, goal_at(inside)), PlanErrc::goals_hit);
  EXPECT_EQ(reason(kHere, goal_at(beyond)), PlanErrc::goals_outside);
  EXPECT_EQ(reason(kHere, {}), PlanErrc::bad_input);
  EXPECT_EQ(reason(std::array{std::nan(""), 0.0}, goal_at(kThere)), PlanErrc::bad_input);
}

TEST_F(Ompl, StraightWaysAndNoWayAtAllNeedNoSearch) {
  PostWorld flat;
  const FastChecker blocked = flat.checker();
  const auto none = plan_path(blocked, kHere, goal_at(kHere), ompl_options("BITstar", 100));
  ASSERT_TRUE(none);
  EXPECT_EQ(none->cost, 0);
  flat.world = {};
  const auto straight = plan_path(flat.checker(), kHere, goal_at(kThere), ompl_options("RRT", 100));
  ASSERT_TRUE(straight);
  EXPECT_EQ(straight->q.size(), 2u);
  EXPECT_EQ(straight->counts.samples, 0);
}

TEST_F(Ompl, PlannersThatImproveUseTheirTimeAndTheOthersDoNot) {
  const PostWorld flat;
  const FastChecker checker = flat.checker();
  for (const bool improves : {false, true}) {
    PlanOptions options = ompl_options(improves ? "BITstar" : "RRTConnect", 0);
    options.time_budget = improves ? 0.3 : 60;
    const Stopwatch watch;
    const auto path = plan_path(checker, kHere, goal_at(kThere), options);
    ASSERT_TRUE(path);
    expect_clear(checker, flat.world, path->q);
    EXPECT_TRUE(improves ? watch.us() > 0.2e6 : watch.us() < 30e6);
  }
}

TEST_F(Ompl, TheTimeLimitEndsASearchThatFindsNothing) {
  PostWorld flat;
  flat.world = {};
  for (const double angle : {-1.1, -0.5}) {
    flat.add_post(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.03);
  }
  for (const char* name : {"RRTConnect", "RRTstar"}) {
    PlanOptions options = ompl_options(name, 10'000'000);
    options.time_limit = 0.05;
    const auto path = plan_path(flat.checker(), kHere, goal_at(kThere), options);
    ASSERT_FALSE(path);
    EXPECT_EQ(path.error().code, PlanErrc::out_of_time) << name;
    EXPECT_LT(path.error().samples, 10'000'000) << name;
  }
}

TEST_F(Ompl, TimeEndsASearchThatFindsNothing) {
  PostWorld flat;
  flat.world = {};
  for (const double angle : {-1.1, -0.5}) {
    flat.add_post(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.03);
  }
  PlanOptions options = ompl_options("RRTstar", 1'000'000);
  options.time_budget = 0.05;
  const Stopwatch watch;
  const auto path = plan_path(flat.checker(), kHere, goal_at(kThere), options);
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, PlanErrc::budget_spent);
  EXPECT_LT(path.error().samples, 1'000'000);
  EXPECT_LT(watch.us(), 10e6);
}

TEST_F(Ompl, UnknownPlannersAreNotAvailable) {
  const PostWorld flat;
  const FastChecker checker = flat.checker();
  const auto path = plan_path(checker, kHere, goal_at(kThere), ompl_options("Dijkstra", 100));
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, PlanErrc::not_available);
  const std::string line = describe(path.error(), checker.robot(), flat.world);
  EXPECT_NE(line.find("known: RRTConnect, RRT"), std::string::npos) << line;
}

TEST(OmplNotBuiltIn, SaysHowToGetIt) {
  if (!ompl_version().empty()) GTEST_SKIP() << "OMPL is built in";
  const PostWorld flat;
  const FastChecker checker = flat.checker();
  const auto path = plan_path(checker, kHere, goal_at(kThere), ompl_options("RRTConnect", 100));
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, PlanErrc::not_available);
  const std::string line = describe(path.error(), checker.robot(), flat.world);
  EXPECT_NE(line.find("libompl-dev"), std::string::npos) << line;
}

}  // namespace
}  // namespace mjarm
