// What paths keep from all else: asked, preferred, and where start and goal have less.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "mjarm/planning/plan_answer.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/slider_test.hpp"
#include "mjarm/planning/two_problems_test.hpp"
#include "mjarm/planning/verify_path.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using nlohmann::json;
using testing::goals_at;
using testing::slider;

/// [m] the least distance by MuJoCo's own geometry on edge `i`, every 0.5 mm.
double exact_clearance(const Robot& robot, const PlannedPath& path, std::size_t i) {
  ExactChecker checker(robot.model, robot.arm, {.margin = 1});
  double least = 1;
  const JointVec way = path.q[i + 1] - path.q[i];
  const int samples = std::max(2, static_cast<int>(way.norm() / 5e-4));
  for (int k = 0; k <= samples; ++k) {
    const auto report = checker.check(as_span(path.q[i] + way * k / samples)).value();
    if (report.nearest) least = std::min(least, report.nearest->distance);
  }
  return least;
}
double exact_clearance(const Robot& robot, const PlannedPath& path) {
  double least = 1;
  for (std::size_t i = 0; i + 1 < path.q.size(); ++i) {
    least = std::min(least, exact_clearance(robot, path, i));
  }
  return least;
}

const std::vector<double> kLeftOfFence{-0.4, 0.1};
std::vector<JointVec> right() { return goals_at({{0.4, 0.1}}); }

TEST(Clearance, WhatIsAskedIsKeptInExactGeometry) {
  const Robot robot = slider(0.3);
  PlanningWorld world = PlanningWorld::create(robot).value();
  for (const double asked : {0.01, 0.03, 0.06}) {
    const auto path = world.plan(kLeftOfFence, right(), {.clearance = asked});
    ASSERT_TRUE(path) << path.error().what;
    EXPECT_EQ(path->clearance, asked);
    ASSERT_EQ(path->kept.size(), path->proof.size());
    for (const double kept : path->kept) EXPECT_EQ(kept, asked);
    EXPECT_GE(exact_clearance(robot, *path), asked);
    for (const EdgeCertificate& proof : path->proof)
      EXPECT_GE(proof.nearest.distance, asked - 1e-6);
  }
}

TEST(Clearance, NothingAskedPrefersFiveMillimetresAndNoneIsNone) {
  const Robot robot = slider(0.3);
  PlanningWorld world = PlanningWorld::create(robot).value();
  const auto preferred = world.plan(kLeftOfFence, right());
  ASSERT_TRUE(preferred);
  EXPECT_EQ(preferred->clearance, kPreferredClearance);
  EXPECT_GE(exact_clearance(robot, *preferred), kPreferredClearance);
  const auto none = world.plan(kLeftOfFence, right(), {.clearance = 0});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->clearance, 0);
  EXPECT_TRUE(none->kept.empty());
  EXPECT_LT(none->cost, preferred->cost);
  // 3 mm of room: what is preferred is not possible, and a path is found all the same.
  const Robot low = slider(0.046);
  PlanningWorld tight = PlanningWorld::create(low).value();
  const auto through = tight.plan(kLeftOfFence, right());
  ASSERT_TRUE(through) << through.error().what;
  EXPECT_EQ(through->clearance, 0);
}

/// The ball begins 4 mm above the table and ends 2 mm above it.
TEST(Clearance, StartAndGoalMayBeNearerAndTheShortWayAwayFromThem) {
  const Robot robot = slider(0.3);
  PlanningWorld world = PlanningWorld::create(robot).value();
  const std::vector<double> low{-0.4, 0.024};
  const auto goals = goals_at({{0.4, 0.022}});
  const auto path = world.plan(low, goals, {.clearance = 0.03});
  ASSERT_TRUE(path) << path.error().what;
  EXPECT_EQ(path->q.front(), joint_vec(low));
  EXPECT_EQ(path->q.back(), goals.front());
  EXPECT_EQ(path->goal, 0);
  const std::size_t last = path->kept.size() - 1;
  EXPECT_LT(path->kept.front(), 0.004);
  EXPECT_GT(path->kept.front(), 0.003);
  EXPECT_GT(path->kept.back(), 0.001);
  for (std::size_t i = 0; i <= last; ++i) {
    if (i > 0 && i < last) {
      EXPECT_EQ(path->kept[i], 0.03);
    }
    EXPECT_GE(exact_clearance(robot, *path, i), path->kept[i]) << i;
  }
  // No farther away than is needed: 26 mm up.
  EXPECT_LT((path->q[1] - path->q[0]).norm(), 0.08);
  EXPECT_LT((path->q[last + 1] - path->q[last]).norm(), 0.08);
  EXPECT_NEAR(path->cost, path_length(path->q), 1e-12);
}

TEST(Clearance, WhereNoPathKeepsItTheLargestThatIsPossibleIsSaid) {
  const LanguageScope english(Language::english);
  const Robot robot = slider(0.1);  // 30 mm above and below the ball
  PlanningWorld world = PlanningWorld::create(robot).value();
  const auto none = world.plan(kLeftOfFence, right(), {.time_limit = 0, .clearance = 0.05});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().search.code, PlanErrc::too_near);
  const double possible = none.error().search.possible;
  EXPECT_GT(possible, 0.026);
  EXPECT_LT(possible, 0.03);
  EXPECT_NE(none.error().what.find("clearance of 50 mm"), std::string::npos) << none.error().what;
  const auto path = world.plan(kLeftOfFence, right(), {.clearance = possible});
  ASSERT_TRUE(path);
  EXPECT_GE(exact_clearance(robot, *path), possible);
  // Nothing is said to be possible where there is no path at all.
  PlanningWorld closed = PlanningWorld::create(slider(0.03)).value();
  const auto shut = closed.plan(kLeftOfFence, right(), {.samples = 300, .clearance = 0.01});
  ASSERT_FALSE(shut);
  EXPECT_EQ(shut.error().search.code, PlanErrc::enclosed);
  // Nor does a search for it last for longer than all of them may.
  // Here the ball has a hundredth of a millimetre, too little for any proof.
  PlanningWorld narrow = PlanningWorld::create(slider(0.04002)).value();
  const auto late =
      narrow.plan(kLeftOfFence, right(), {.samples = 100'000'000, .time_limit = 0.05});
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().search.code, PlanErrc::out_of_time);
  EXPECT_NE(late.error().what.find("within 0.05 s"), std::string::npos) << late.error().what;
  for (const double wrong : {-0.001, 0.6, std::numeric_limits<double>::quiet_NaN()}) {
    const auto refused = world.plan(kLeftOfFence, right(), {.clearance = wrong});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().search.code, PlanErrc::bad_clearance);
    EXPECT_NE(refused.error().what.find("0.5 m"), std::string::npos) << refused.error().what;
  }
}

/// Of a file of problems: keeps nothing unless asked, and what is written is verified by other
/// code.
class ClearanceOfFiles : public ::testing::Test {
 protected:
  std::string answer(const std::optional<double>& clearance) {
    const PlanAnswer found = answer_problem(robot_, file_.problems[0], {.clearance = clearance});
    std::string out = "{\"round\":";
    append_answer(out, found, robot_, file_.problems[0].obstacles, false);
    return out + "}";
  }
  std::vector<std::string> faults(const json& answer) {
    const std::string path = folder_.write("paths.json", answer.dump()).string();
    std::vector<std::string> kinds;
    const GivenPath given = read_plan_file(path, 2).value().at(0);
    const PathVerdict verdict = verify_path(file_, file_.problems[0], given, {}).value();
    for (const PathFault& fault : verdict.faults) kinds.push_back(fault.kind);
    return kinds;
  }

  support::TempFolder folder_;
  ProblemFile file_ =
      read_problem_file(folder_.write("in.json", testing::two_problems().dump()).string()).value();
  FastRobot robot_ = FastRobot::create(file_.arm, file_.spheres).value();
};

TEST_F(ClearanceOfFiles, NoneIsAsked) {
  EXPECT_EQ(answer({}), answer(0));
  EXPECT_EQ(answer({}).find("kept"), std::string::npos);
  EXPECT_EQ(answer({}).find("\"clearance\":0}"), std::string::npos);
}

TEST_F(ClearanceOfFiles, WhatIsKeptIsWrittenAndVerified) {
  const json sound = json::parse(answer(0.03));
  const json& path = sound.at("round");
  ASSERT_TRUE(path.at("ok").get<bool>());
  EXPECT_EQ(path.at("clearance"), 0.03);
  for (const json& edge : path.at("certificate")) {
    EXPECT_EQ(edge.at("kept"), 0.03);
    EXPECT_GE(edge.at("clearance").get<double>(), 0.03 - 1e-6);
  }
  EXPECT_EQ(faults(sound), std::vector<std::string>{});
  const std::vector<std::string> wrong{"clearance"};
  json more = sound;
  more["round"]["clearance"] = 0.4;
  EXPECT_EQ(faults(more), wrong) << "the edges keep less, away from start and goal";
  for (json& edge : more["round"]["certificate"]) edge["kept"] = 0.4;
  EXPECT_EQ(faults(more), wrong) << "which is not true";
  json unsaid = sound;
  for (json& edge : unsaid["round"]["certificate"]) edge.erase("kept");
  EXPECT_EQ(faults(unsaid), wrong);
}

}  // namespace
}  // namespace mjarm
