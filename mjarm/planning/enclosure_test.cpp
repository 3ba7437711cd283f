#include "mjarm/planning/enclosure.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/planning/cages_test.hpp"
#include "mjarm/planning/ompl_planners.hpp"
#include "mjarm/planning/plan_answer.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/slider_test.hpp"
#include "tests/support/test_data.hpp"

namespace mjarm {
namespace {

using testing::Caged;

FastChecker checker_of(const Caged& caged) {
  return FastChecker::create(FastRobot::create(caged.arm, caged.set).value(), caged.world).value();
}

std::optional<Pocket> pocket_of(const Caged& caged) {
  const std::vector<JointVec> goals{caged.way.back()};
  const FastChecker checker = checker_of(caged);
  return EnclosureTest(checker, caged.world, as_span(caged.way.front()), goals).find();
}

Caged random_caged(bool open, Rng& rng) {
  return rng.uniform() < 0.5 ? testing::flying_robot(open, rng)
                             : testing::reaching_robot(open, rng);
}

/// [m] The least on the straight way, in double precision.
double clearance_of_way(const Caged& caged) {
  double least = 1;
  for (int k = 0; k <= 60; ++k) {
    const JointVec q = caged.way[0] + k / 60.0 * (caged.way[1] - caged.way[0]);
    least = std::min(least, testing::true_clearance(caged.arm, caged.set, caged.world, as_span(q)));
  }
  return least;
}

TEST(Enclosure, EveryClosedCageIsProved) {
  Rng rng(71);
  for (int k = 0; k < testing::rounds(20, 1000, 5); ++k) {
    const Caged caged = random_caged(false, rng);
    const FastChecker checker = checker_of(caged);
    ASSERT_TRUE(checker.is_free(as_span(caged.way.front()))) << k;
    ASSERT_TRUE(checker.is_free(as_span(caged.way.back()))) << k;
    const auto pocket = pocket_of(caged);
    ASSERT_TRUE(pocket) << k;
    EXPECT_EQ(caged.set.links[static_cast<std::size_t>(pocket->link)].name, "hand");
    EXPECT_EQ(pocket->radius, caged.widest);
    EXPECT_EQ(pocket->goals, 1);
  }
}

TEST(Enclosure, NoCageThatIsNearlyClosedIsCalledSo) {
  Rng rng(72);
  for (int k = 0; k < testing::rounds(20, 1000, 5); ++k) {
    const Caged caged = random_caged(true, rng);
    ASSERT_GT(clearance_of_way(caged), 0) << k;
    EXPECT_FALSE(pocket_of(caged)) << k;
  }
}

TEST(Enclosure, AllGoalsHaveToBeCutOff) {
  Rng rng(73);
  const Caged caged = testing::flying_robot(false, rng);
  const JointVec &shut = caged.way[caged.inside], &away = caged.way[1 - caged.inside];
  const FastChecker checker = checker_of(caged);
  std::vector<JointVec> goals{shut};
  const std::span<const double> start = as_span(away);
  const auto pocket = EnclosureTest(checker, caged.world, start, goals).find();
  ASSERT_TRUE(pocket);
  EXPECT_TRUE(pocket->at_goal);
  const std::vector<JointVec> ends{away};
  EXPECT_EQ(EnclosureTest(checker, caged.world, as_span(shut), ends).find()->at_goal, false);
  goals.push_back(shut);  // in another winding of the wrist
  goals.back()[3] = -2;
  EXPECT_EQ(EnclosureTest(checker, caged.world, start, goals).find()->goals, 2);
  goals.push_back(away);
  goals.back()[0] += 0.1;
  EXPECT_FALSE(EnclosureTest(checker, caged.world, start, goals).find());
}

TEST(Enclosure, NoSolvableProblemOfOthersIsCalledSo) {
  for (const char* name : {"panda", "ur5"}) {
    MJARM_TEST_FILE(path, std::string("motionbenchmaker/mbm_") + name + "_public.json.gz");
    const auto file = read_problem_file(path.string());
    ASSERT_TRUE(file) << file.error().what;
    const FastRobot robot = FastRobot::create(file->arm, file->spheres).value();
    const auto step = static_cast<std::size_t>(testing::rounds(20, 1));
    for (std::size_t k = 0; k < file->problems.size(); k += step) {
      const PlanProblem& problem = file->problems[k];
      const FastChecker checker = FastChecker::create(robot, problem.obstacles).value();
      EXPECT_FALSE(EnclosureTest(checker, problem.obstacles, problem.start, problem.goals).find())
          << problem.id;
    }
  }
}

/// A closed cage as a problem of a file.
PlanProblem closed_problem(const Caged& caged) {
  PlanProblem out;
  out.id = "caged";
  const std::span<const double> start = as_span(caged.way.front());
  out.start.assign(start.begin(), start.end());
  out.goals = {caged.way.back()};
  out.obstacles = caged.world;
  return out;
}

TEST(Enclosure, EndsEverySearch) {
  Rng rng(74);
  const Caged caged = testing::reaching_robot(false, rng);
  const FastRobot robot = FastRobot::create(caged.arm, caged.set).value();
  const PlanProblem problem = closed_problem(caged);
  std::vector<PlanOptions> searches{
      {}, {.planner = Planner::rrt_star}, {.samples = 50}, {.clearance = 0.001}};
  if (!ompl_version().empty()) searches.push_back({.planner = Planner::ompl});
  for (const PlanOptions& options : searches) {
    const PlanAnswer answer = answer_problem(robot, problem, options);
    ASSERT_FALSE(answer.path);
    EXPECT_EQ(answer.path.error().code, PlanErrc::enclosed);
    EXPECT_LE(answer.path.error().samples, 2001);
    EXPECT_GT(answer.path.error().pocket.volume, 0);
    EXPECT_LT(answer.path.error().pocket.volume, 0.1);
    std::string line;
    append_answer(line, answer, robot, problem.obstacles, false);
    EXPECT_NE(line.find(R"("enclosed":{"link":"hand")"), std::string::npos) << line;
    EXPECT_NE(line.find("no path exists to the goal configuration: the ball of radius"),
              std::string::npos);
    const LanguageScope chinese(Language::chinese);
    EXPECT_NE(describe(answer.path.error(), robot, problem.obstacles).find("连杆“hand”内半径"),
              std::string::npos);
  }
}

TEST(Enclosure, IsOfTheExactGeometryOfAModel) {
  const std::vector<double> start{-0.4, 0.1};
  const std::vector<JointVec> goals{joint_vec(std::vector<double>{0.4, 0.1})};
  for (const double room : {0.039, 0.041}) {
    const Robot robot = testing::slider(room);
    PlanningWorld world = PlanningWorld::create(robot).value();
    const auto path = world.plan(start, goals, {.time_limit = 0});
    EXPECT_EQ(path.has_value(), room > 0.04);
    if (path) continue;
    EXPECT_EQ(path.error().search.code, PlanErrc::enclosed);
    EXPECT_EQ(path.error().search.pocket.radius, 0.02);
    EXPECT_NE(path.error().what.find("no path exists"), std::string::npos) << path.error().what;
  }
}

TEST(SearchProgress, IsToldAfterEveryFewSamples) {
  Rng rng(75);
  const Caged caged = testing::reaching_robot(false, rng);
  const FastChecker checker = checker_of(caged);
  std::vector<SearchProgress> told;
  const auto path =
      plan_path(checker, as_span(caged.way.front()), std::vector{caged.way.back()},
                {.samples = 40, .progress = [&](const SearchProgress& at) { told.push_back(at); }});
  ASSERT_FALSE(path);
  ASSERT_GE(told.size(), 11u);
  for (std::size_t k = 1; k < told.size(); ++k) {
    EXPECT_GT(told[k].samples, told[k - 1].samples);
    EXPECT_LE(told[k].samples, told[k - 1].samples + 4);
  }
  EXPECT_EQ(told.back().samples, 40);
  EXPECT_EQ(told.back().nearest, path.error().nearest);
}

}  // namespace
}  // namespace mjarm
