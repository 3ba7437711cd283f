#include "mjarm/planning/plan_path.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "mjarm/collision/random_scene_test.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "mjarm/planning/search_internal.hpp"

namespace mjarm {
namespace {

using testing::goal_at;
using testing::goals_at;

/// Two links of 0.5 m that turn about z, each a row of balls of 0.06 m.
Arm flat_arm() {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  return testing::make_arm(
      "flat", {{{0, 0, 0}, {0, 0, 0}, z, -3, 3}, {{0.5, 0, 0}, {0, 0, 0}, z, -2.8, 2.8}},
      {{0.5, 0, 0}, Eigen::Matrix3d::Identity()});
}

SphereSet flat_spheres() {
  SphereSet set;
  for (int joint = 0; joint < 2; ++joint) {
    set.links.push_back({joint == 0 ? "upper" : "lower", joint, {}});
    for (int k = 1; k <= 10; ++k) set.links.back().spheres.push_back({{0.05 * k, 0, 0}, 0.04});
  }
  return set;
}

/// A post in the way of the straight edge from kLeft to kRight.
Obstacles post(double radius = 0.05) {
  Obstacles world;
  world.solids.push_back(
      {"post", {{0.7, 0, 0}, Eigen::Matrix3d::Identity()}, CapsuleShape{radius, 0.3}});
  return world;
}

constexpr std::array<double, 2> kLeft{0.8, 0}, kRight{-0.8, 0};

FastChecker checker_of(const Arm& arm, const SphereSet& set, const Obstacles& world) {
  return FastChecker::create(FastRobot::create(arm, set).value(), world).value();
}

/// Looks at every edge at many places, with plain double-precision code.
void expect_free(const FastChecker& checker, const Obstacles& world, const PlannedPath& path) {
  const FastRobot& robot = checker.robot();
  ASSERT_GE(path.q.size(), 2u);
  ASSERT_EQ(path.proof.size() + 1, path.q.size());
  const JointLimits& limits = robot.arm().limits;
  for (const JointVec& q : path.q) {
    EXPECT_GE((q - limits.lower).minCoeff(), -1e-4);
    EXPECT_GE((limits.upper - q).minCoeff(), -1e-4);
  }
  double cost = 0;
  for (std::size_t i = 1; i < path.q.size(); ++i) {
    const JointVec way = path.q[i] - path.q[i - 1];
    cost += way.norm();
    const int samples = std::max(2, static_cast<int>(way.norm() / 0.01));
    for (int k = 0; k <= samples; ++k) {
      const JointVec q = path.q[i - 1] + way * k / samples;
      EXPECT_GT(testing::true_clearance(robot.arm(), robot.spheres(), world, as_span(q)), 0);
    }
    EXPECT_GT(path.proof[i - 1].nearest.distance, 0);
    EXPECT_GE(path.proof[i - 1].step, 0);
  }
  EXPECT_NEAR(path.cost, cost, 1e-12);
}

std::vector<double> rows(const std::vector<JointVec>& path) {
  std::vector<double> out;
  for (const JointVec& q : path) out.insert(out.end(), q.begin(), q.end());
  return out;
}

TEST(PlanPath, GoesRoundAPostThatTheStraightWayHits) {
  const Arm arm = flat_arm();
  const FastChecker checker = checker_of(arm, flat_spheres(), post());
  ASSERT_EQ(check_edge(checker, kLeft, kRight).verdict, EdgeVerdict::hit);
  const auto path = plan_path(checker, kLeft, goal_at(kRight));
  ASSERT_TRUE(path);
  EXPECT_GT(path->q.size(), 2u);
  EXPECT_EQ(path->q.front(), joint_vec(kLeft));
  EXPECT_EQ(path->q.back(), joint_vec(kRight));
  expect_free(checker, post(), *path);
}

TEST(PlanPath, TakesTheStraightWayWhereItIsFree) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), {});
  const auto path = plan_path(checker, kLeft, goal_at(kRight));
  ASSERT_TRUE(path);
  EXPECT_EQ(path->q.size(), 2u);
  EXPECT_NEAR(path->cost, 1.6, 1e-12);
}

TEST(EdgeProver, LimitsCountAsTheyDoForStartAndGoals) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), {});
  PlanCounts counts;
  detail::EdgeProver prover(checker, nullptr, {}, counts);
  const std::array<double, 2> inside{0, 0}, rounded{3 + 0.9e-4, 0}, outside{3 + 1.1e-4, 0},
      below{0, -2.8 - 1.1e-4};
  ASSERT_EQ(check_edge(checker, inside, outside).verdict, EdgeVerdict::free);
  EXPECT_TRUE(prover.is_free(inside, rounded));
  EXPECT_FALSE(prover.is_free(inside, outside));
  EXPECT_FALSE(prover.is_free(outside, inside));
  EXPECT_FALSE(prover.is_free(inside, below));
  EXPECT_EQ(counts.edges, 4);
}

TEST(PlanPath, AStartThatIsTheGoalIsAPathOfNoLength) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), post());
  const auto path = plan_path(checker, kLeft, goal_at(kLeft));
  ASSERT_TRUE(path);
  EXPECT_EQ(path->q.size(), 2u);
  EXPECT_EQ(path->cost, 0);
}

/// The tree is one: every node but the roots hangs on another by an edge that is proved.
void expect_tree(const FastChecker& checker, const SearchTree& tree) {
  ASSERT_FALSE(tree.q.empty());
  ASSERT_EQ(tree.parents.size(), tree.q.size());
  for (std::size_t i = 0; i < tree.q.size(); ++i) {
    std::size_t node = i, steps = 0;
    for (; tree.parents[node] >= 0 && steps <= tree.q.size(); ++steps) {
      ASSERT_LT(tree.parents[node], static_cast<int>(tree.q.size()));
      node = static_cast<std::size_t>(tree.parents[node]);
    }
    EXPECT_LE(steps, tree.q.size());
    if (tree.parents[i] < 0) continue;
    const JointVec& from = tree.q[static_cast<std::size_t>(tree.parents[i])];
    EXPECT_EQ(check_edge(checker, as_span(from), as_span(tree.q[i])).verdict, EdgeVerdict::free);
  }
}

TEST(PlanPath, HandsOverItsTreesWhereTheyAreAskedFor) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), post());
  for (const Planner planner : {Planner::rrt_connect, Planner::rrt_star}) {
    PlanOptions options{.planner = planner, .samples = 300};
    const auto without = plan_path(checker, kLeft, goal_at(kRight), options);
    options.keep_trees = true;
    const auto with = plan_path(checker, kLeft, goal_at(kRight), options);
    ASSERT_TRUE(without);
    ASSERT_TRUE(with);
    EXPECT_TRUE(without->trees.empty());
    EXPECT_EQ(rows(with->q), rows(without->q));
    ASSERT_EQ(with->trees.size(), planner == Planner::rrt_connect ? 2U : 1U);
    for (const SearchTree& tree : with->trees) expect_tree(checker, tree);
    EXPECT_EQ(with->trees.front().q.front(), joint_vec(kLeft));
    EXPECT_EQ(with->trees.front().parents.front(), -1);
    const JointVec root = joint_vec(planner == Planner::rrt_connect ? kRight : kLeft);
    EXPECT_EQ(with->trees.back().q.front(), root);
  }
}

TEST(PlanPath, RoundsHandOverTheTreesOfTheSearchThatFoundThePath) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), post());
  const auto path = plan_path(checker, kLeft, goal_at(kRight), {.rounds = 5, .keep_trees = true});
  ASSERT_TRUE(path);
  ASSERT_EQ(path->trees.size(), 2U);
  for (const SearchTree& tree : path->trees) expect_tree(checker, tree);
}

TEST(PlanPath, EndsAtOneOfTheGoalsAndSaysWhich) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), post());
  // In collision, outside of the limits, behind the post, near.
  const auto goals = goals_at({{0, 0}, {0, 5}, {-0.8, 0}, {1.4, 0.3}});
  const auto path = plan_path(checker, kLeft, goals);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->goal, 3);
  EXPECT_EQ(path->q.back(), goals[3]);
}

TEST(PlanPath, SaysWhyThereIsNone) {
  const Arm arm = flat_arm();
  const FastChecker checker = checker_of(arm, flat_spheres(), post());
  const std::array<double, 2> inside{0, 0}, beyond{0, 3.5};
  const auto reason = [&](std::span<const double> start, const std::vector<JointVec>& goals) {
    const auto path = plan_path(checker, start, goals);
    return path ? PlanErrc::unproved : path.error().code;
  };
  EXPECT_EQ(reason(inside, goal_at(kRight)), PlanErrc::start_hit);
  EXPECT_EQ(reason(beyond, goal_at(kRight)), PlanErrc::start_outside);
  EXPECT_EQ(reason(kLeft, goal_at(inside)), PlanErrc::goals_hit);
  EXPECT_EQ(reason(kLeft, goal_at(beyond)), PlanErrc::goals_outside);
  EXPECT_EQ(reason(kLeft, {}), PlanErrc::bad_input);
  EXPECT_EQ(reason(kLeft, goal_at(std::array{0.1, 0.2, 0.3})), PlanErrc::bad_input);
  EXPECT_EQ(reason({kLeft.data(), 1}, goal_at(kRight)), PlanErrc::bad_input);
  EXPECT_EQ(reason(std::array{std::nan(""), 0.0}, goal_at(kRight)), PlanErrc::bad_input);
  EXPECT_EQ(reason(kLeft, goal_at(std::array{std::numeric_limits<double>::infinity(), 0.0})),
            PlanErrc::bad_input);
}

TEST(PlanPath, NamesWhatOverlaps) {
  const Obstacles world = post();
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), world);
  const auto path = plan_path(checker, std::array{0.0, 0.0}, goal_at(kRight));
  ASSERT_FALSE(path);
  // Radii are padded, so that the depth is a hair more.
  EXPECT_NE(
      describe(path.error(), checker.robot(), world)
          .find("the start is in collision: link \"lower\" overlaps obstacle \"post\" by 90.0"),
      std::string::npos);
  const auto outside = plan_path(checker, std::array{0.0, 3.5}, goal_at(kRight));
  EXPECT_EQ(describe(outside.error(), checker.robot(), world),
            "the start is outside of the limits: joint \"joint2\" at 3.5, expected -2.8 to 2.8");
}

TEST(PlanPath, ALinkAtRestThatOverlapsIsNamed) {
  SphereSet set = flat_spheres();
  set.links.push_back({"foot", -1, {{{0, 0, -0.3}, 0.1}}});
  Obstacles world;
  world.solids.push_back({"floor", {{0, 0, -0.3}, Eigen::Matrix3d::Identity()}, HalfSpaceShape{}});
  const FastChecker checker = checker_of(flat_arm(), set, world);
  const auto path = plan_path(checker, kLeft, goal_at(kRight));
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().code, PlanErrc::base_hit);
  EXPECT_EQ(describe(path.error(), checker.robot(), world),
            "link \"foot\" stands still and overlaps obstacle \"floor\": no motion can undo that");
}

/// Posts to both sides of kRight, so close that the arm does not get between them.
Obstacles wall_round_the_goal() {
  Obstacles world;
  for (const double angle : {-1.1, -0.5}) {
    const Eigen::Vector3d p(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0);
    world.solids.push_back({"post", {p, Eigen::Matrix3d::Identity()}, CapsuleShape{0.03, 0.2}});
  }
  return world;
}

TEST(PlanPath, AGoalWalledInSpendsTheBudgetAndSaysHowNearItCame) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), wall_round_the_goal());
  ASSERT_TRUE(checker.is_free(kRight));
  for (const Planner planner : {Planner::rrt_connect, Planner::rrt_star}) {
    PlanOptions options;
    options.planner = planner;
    options.samples = 500;
    const auto path = plan_path(checker, kLeft, goal_at(kRight), options);
    ASSERT_FALSE(path);
    EXPECT_EQ(path.error().code, PlanErrc::budget_spent);
    EXPECT_EQ(path.error().samples, 500);
    EXPECT_GT(path.error().nearest, 0.1);
    EXPECT_LT(path.error().nearest, 1.6);
  }
}

TEST(PlanPath, TheTimeLimitEndsWhatWouldNotEnd) {
  const LanguageScope english(Language::english);
  const Obstacles world = wall_round_the_goal();
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), world);
  for (const Planner planner : {Planner::rrt_connect, Planner::rrt_star}) {
    const PlanOptions options{
        .planner = planner, .samples = std::numeric_limits<int>::max(), .time_limit = 0.05};
    const Stopwatch watch;
    const auto path = plan_path(checker, kLeft, goal_at(kRight), options);
    EXPECT_GT(watch.us(), 0.05e6);
    ASSERT_FALSE(path);
    EXPECT_EQ(path.error().code, PlanErrc::out_of_time);
    EXPECT_GT(path.error().samples, 0);
    EXPECT_GT(path.error().nearest, 0.1);
    const std::string told = describe(path.error(), checker.robot(), world);
    EXPECT_NE(told.find("no path within 0.05 s"), std::string::npos) << told;
  }
  // A budget that is spent before is told as ever, and so it is where there is no limit.
  for (const double limit : {3600.0, 0.0}) {
    const auto path =
        plan_path(checker, kLeft, goal_at(kRight), {.samples = 50, .time_limit = limit});
    ASSERT_FALSE(path);
    EXPECT_EQ(path.error().code, PlanErrc::budget_spent);
  }
}

TEST(PlanPath, TheTimeLimitNeverTakesAPathAway) {
  // The search of a shorter path goes on for longer than the limit.
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), {});
  const PlanOptions options{.time_limit = 1e-9, .time_budget = 0.02};
  const auto path = plan_path(checker, kLeft, goal_at(kRight), options);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->q.size(), 2U);
  // Nor one with corners, which is shortened until long after the limit.
  const FastChecker round = checker_of(flat_arm(), flat_spheres(), post());
  const Stopwatch watch;
  const auto shorter =
      plan_path(round, kLeft, goal_at(kRight), {.time_limit = 0.3, .time_budget = 0.6});
  ASSERT_TRUE(shorter);
  EXPECT_GT(shorter->q.size(), 2U);
  EXPECT_GT(watch.us(), 0.3e6);
}

TEST(PlanPath, SameSeedSamePathAndOthersDiffer) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), post());
  PlanOptions options;
  for (const Planner planner : {Planner::rrt_connect, Planner::rrt_star}) {
    options.planner = planner;
    options.seed = 1;
    const auto first = plan_path(checker, kLeft, goal_at(kRight), options);
    const auto again = plan_path(checker, kLeft, goal_at(kRight), options);
    options.seed = 2;
    const auto other = plan_path(checker, kLeft, goal_at(kRight), options);
    ASSERT_TRUE(first && again && other);
    EXPECT_EQ(rows(first->q), rows(again->q));
    EXPECT_NE(rows(first->q), rows(other->q));
  }
}

TEST(PlanPath, RoundsNeverLengthenAndTheBestWayIsNearlyFound) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), post());
  PlanOptions options;
  options.shortcuts = 0;
  const double first = plan_path(checker, kLeft, goal_at(kRight), options).value().cost;
  double before = first;
  for (const int rounds : {1, 5, 50}) {
    options.rounds = rounds;
    const auto path = plan_path(checker, kLeft, goal_at(kRight), options);
    ASSERT_TRUE(path);
    expect_free(checker, post(), *path);
    EXPECT_LE(path->cost, before + 1e-9);
    before = path->cost;
  }
  // A long search with the other planner finds nothing much shorter.
  options.planner = Planner::rrt_star;
  options.samples = 2000;
  options.rounds = 0;
  EXPECT_GT(plan_path(checker, kLeft, goal_at(kRight), options).value().cost, 0.97 * before);
  EXPECT_LT(before, first);
}

TEST(PlanPath, RoundsLookBeyondAGoalThatIsStraightAhead) {
  // The far goal can be reached straight; the near one, round a post, is still nearer.
  Obstacles world = post();
  world.solids.front().X_WO.p.x() = 0.9;
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), world);
  const std::array<double, 2> start{0.35, 0};
  const auto goals = goals_at({{-0.35, 0}, {2.9, 2.79}});
  ASSERT_EQ(check_edge(checker, start, as_span(goals[0])).verdict, EdgeVerdict::hit);
  PlanOptions options;
  EXPECT_EQ(plan_path(checker, start, goals, options).value().goal, 1);
  options.rounds = 20;
  EXPECT_EQ(plan_path(checker, start, goals, options).value().goal, 0);
}

TEST(PlanPath, ATimeBudgetIsKept) {
  const FastChecker checker = checker_of(flat_arm(), flat_spheres(), post());
  PlanOptions options;
  options.time_budget = 1e-3;
  const auto path = plan_path(checker, kLeft, goal_at(kRight), options);
  ASSERT_TRUE(path);
  expect_free(checker, post(), *path);
  options.time_budget = 1e-9;  // spent before anything was found: the first path counts
  EXPECT_TRUE(plan_path(checker, kLeft, goal_at(kRight), options));
}

/// Random arms between random solids: every path is free by other code.
class PlanRandomWorlds : public ::testing::TestWithParam<Planner> {};

TEST_P(PlanRandomWorlds, EveryPathIsFree) {
  Rng rng(7);
  int planned = 0, bent = 0;
  for (int round = 0; round < testing::rounds(60, 3000); ++round) {
    const Arm arm = testing::random_arm(2 + static_cast<int>(rng.below(6)), rng);
    SphereSet set = testing::random_spheres(arm, rng);
    const Obstacles world = testing::random_world(rng, 6);
    const auto robot = FastRobot::create(arm, set);
    if (!robot) continue;
    const FastChecker checker = FastChecker::create(*robot, world).value();
    const JointVec start = testing::random_q(arm, rng), goal = testing::random_q(arm, rng);
    PlanOptions options;
    options.planner = GetParam();
    options.samples = 300;
    options.seed = static_cast<std::uint64_t>(round);
    const auto path = plan_path(checker, as_span(start), goal_at(as_span(goal)), options);
    if (!path) {
      EXPECT_FALSE(describe(path.error(), *robot, world).empty());
      EXPECT_NE(path.error().code, PlanErrc::unproved);
      EXPECT_NE(path.error().code, PlanErrc::bad_input);
      continue;
    }
    ++planned;
    bent += path->q.size() > 2 ? 1 : 0;
    expect_free(checker, world, *path);
  }
  EXPECT_GT(planned, 5);
  EXPECT_GT(bent, 1);
}
INSTANTIATE_TEST_SUITE_P(Planners, PlanRandomWorlds,
                         ::testing::Values(Planner::rrt_connect, Planner::rrt_star),
                         [](const auto& param) {
                           return param.param == Planner::rrt_connect ? "RrtConnect" : "RrtStar";
                         });

}  // namespace
}  // namespace mjarm
