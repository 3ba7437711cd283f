// Plants faults in paths and looks whether the verifier finds them, and says no more than is true.
#include "mjarm/planning/verify_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/planning/crane_problems_test.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using nlohmann::json;
using Kinds = std::vector<std::string>;

class VerifyPathTest : public ::testing::Test {
 protected:
  /// The verdict on a path as a file of plans has it.
  PathVerdict verdict(const std::string& id, const json& path, const VerifyRules& rules = {},
                      Cylinders cylinders = Cylinders::replaced) {
    const std::string in = folder_.write("problems.json", problems_.dump()).string();
    const ProblemFile file = read_problem_file(in, cylinders).value();
    const std::string plans = folder_.write("paths.json", json{{id, path}}.dump()).string();
    const std::vector<GivenPath> given = read_plan_file(plans, 2).value();
    const auto problem = std::ranges::find(file.problems, id, &PlanProblem::id);
    return verify_path(file, *problem, given.at(0), rules).value();
  }
  Kinds faults(const std::string& id, const json& path, const VerifyRules& rules = {},
               Cylinders cylinders = Cylinders::replaced) {
    Kinds kinds;
    for (const PathFault& fault : verdict(id, path, rules, cylinders).faults) {
      kinds.push_back(fault.kind);
      EXPECT_FALSE(fault.what.empty());
    }
    return kinds;
  }

  LanguageScope english_{Language::english};
  json problems_ = testing::crane_problems();
  support::TempFolder folder_;
};

TEST_F(VerifyPathTest, EndsMustBeStartAndGoal) {
  const std::string id = "crane/open/0";
  EXPECT_EQ(faults(id, testing::kCraneStraight), Kinds{});
  EXPECT_EQ(faults(id, {{-0.9, 0}, {1, 0}}), Kinds{"start"});
  EXPECT_EQ(faults(id, {{-1, 0}, {1, 0.001}}), Kinds{"goal"});
  EXPECT_EQ(faults(id, {{-1, 5e-5}, {1, 5e-5}}), Kinds{});
  EXPECT_EQ(faults(id, json::array({json::array({-1, 0})})), Kinds{"goal"});
}

TEST_F(VerifyPathTest, LimitsMustBeKept) {
  const std::string id = "crane/open/0";
  EXPECT_EQ(faults(id, {{-1, 0}, {0, 3.00005}, {1, 0}}), Kinds{});
  const PathVerdict beyond = verdict(id, {{-1, 0}, {0, 3.01}, {1, 0}});
  ASSERT_EQ(beyond.faults.size(), 1U);
  EXPECT_EQ(beyond.faults[0].kind, std::string("limits"));
  EXPECT_EQ(beyond.faults[0].edge, 0);
  EXPECT_NE(beyond.faults[0].what.find("row 1: joint \"arm\""), std::string::npos);
}

TEST_F(VerifyPathTest, APlateThinnerThanTheSpacingIsFoundAndMeasured) {
  const std::string id = "crane/plate/0";
  EXPECT_EQ(faults(id, testing::kCraneRound), Kinds{});
  // The ball meets the plate over 40.1 mm of its way of 2 m: samples may miss it, proofs do not.
  EXPECT_EQ(faults(id, testing::kCraneStraight, {.step = 0.3}), Kinds{"hit"});
  const PathVerdict hit = verdict(id, testing::kCraneStraight);
  ASSERT_EQ(hit.faults.size(), 2U);
  EXPECT_EQ(hit.faults[1].kind, std::string("contact"));
  EXPECT_NE(hit.faults[0].what.find("\"hand\" overlaps \"plate\""), std::string::npos);
  EXPECT_NEAR(hit.clearance, -0.02, 1e-4);
  EXPECT_NEAR(hit.cost, 2, 1e-12);
  // Only the first faulty edge is told.
  const PathVerdict thrice = verdict(id, {{-1, 0}, {1, 0}, {-1, 0}, {1, 0}});
  ASSERT_EQ(thrice.faults.size(), 2U);
  EXPECT_EQ(thrice.faults[0].edge, 0);
}

TEST_F(VerifyPathTest, LinksMustNotOverlapEachOther) {
  problems_["robot"]["spheres"][0]["center"] = {0, 0.6, 0.5};
  EXPECT_EQ(faults("crane/open/0", testing::kCraneStraight), (Kinds{"hit", "contact"}));
  problems_["robot"]["self_collision_link_pairs"] = json::array();
  EXPECT_EQ(faults("crane/open/0", testing::kCraneStraight), Kinds{});
}

TEST_F(VerifyPathTest, CostAndCertificatesMustAgree) {
  const std::string id = "crane/pillar/0";
  const auto with = [](const json& patch) {
    json path = {{"ok", true}, {"path", testing::kCraneRound}, {"cost", 8.0}};
    path.merge_patch(patch);
    return path;
  };
  EXPECT_EQ(faults(id, with(json::object())), Kinds{});
  EXPECT_EQ(faults(id, with({{"cost", 7.9}})), Kinds{"cost"});
  const json bare = {{"step", 0.5}, {"clearance", 1}, {"t", 0.5}};
  EXPECT_EQ(faults(id, with({{"certificate", {bare, bare, bare}}})), Kinds{});
  EXPECT_EQ(faults(id, with({{"certificate", {bare, bare}}})), Kinds{"certificate"});
  const auto second = [&](const json& patch) {
    json changed = bare;
    changed.merge_patch(patch);
    return with({{"certificate", {bare, changed, bare}}});
  };
  EXPECT_EQ(faults(id, second({{"step", 2.1}})), Kinds{"certificate"});
  EXPECT_EQ(faults(id, second({{"t", 1.5}})), Kinds{"certificate"});
  // Half-way the ball is below the middle of the pillar's box, whose corner looks down.
  const double y = 0.5 * std::cos(3), x = -0.5 * std::sin(3);
  const double truth = 0.67 - 0.12 * std::sqrt(2) - y - 0.02;
  ASSERT_LT(std::abs(x), 0.1);
  const auto stated = [&](double clearance, const std::string& other = "pillar") {
    return second({{"clearance", clearance}, {"t", 0.5 - x / 2}, {"pair", {"hand", other}}});
  };
  EXPECT_EQ(faults(id, stated(truth - 1e-5)), Kinds{});
  EXPECT_EQ(faults(id, stated(truth + 1e-4)), Kinds{"certificate"});
  EXPECT_EQ(faults(id, stated(truth - 1e-2)), Kinds{"certificate"});
  EXPECT_EQ(faults(id, stated(truth, "pilar")), Kinds{"certificate"});
}

TEST_F(VerifyPathTest, CylindersAsGivenOrReplacedAndOverlapsThatAreAllowed) {
  // The corner of the box that replaces the pillar is in the way, the pillar itself is not.
  const json past = {{-1, 0}, {-1, 0.1}, {1, 0.1}, {1, 0}};
  const std::string id = "crane/pillar/0";
  EXPECT_EQ(faults(id, past), (Kinds{"hit", "contact"}));
  EXPECT_EQ(faults(id, past, {}, Cylinders::exact), Kinds{});
  // The overlap is of 17 mm.
  EXPECT_EQ(faults(id, past, {.allow_depth = 1e-3}), (Kinds{"hit", "contact"}));
  EXPECT_EQ(faults(id, past, {.allow_depth = 18e-3}), Kinds{});
}

TEST_F(VerifyPathTest, ATiltThatIsLargerThanStatedIsFound) {
  const auto with = [](double largest) {
    return json{
        {"path", testing::kCraneRound},
        {"tilt",
         {{"limit", 0.1}, {"largest", largest}, {"tool", {0, 0, 1}}, {"world", {0, 0, 1}}}}};
  };
  EXPECT_EQ(faults("crane/open/0", with(0)), Kinds{});  // it turns about z alone
  json leaning = with(0.05);
  leaning["tilt"]["tool"] = {0, std::sin(0.06), std::cos(0.06)};
  EXPECT_EQ(faults("crane/open/0", leaning), Kinds{"tilt"});
  leaning["tilt"]["largest"] = 0.0601;
  EXPECT_EQ(faults("crane/open/0", leaning), Kinds{});
}

/// What the planner proves is verified, by separate code and by MuJoCo's own geometry; the same
/// path bent into the wall is not.
TEST_F(VerifyPathTest, PlannedPathsAreValidAndBentOnesAreNot) {
  const Robot robot = load_robot("universal_robots_ur5e/wall.xml").value();
  const std::vector<double> start{-4.375, -1.2456, 1.9905, -2.3157, -1.5708, 0};
  const auto goals = testing::goals_at({{-5.551, -1.2456, 1.9905, -2.3157, -1.5708, 0}});
  PlanningWorld world = PlanningWorld::create(robot).value();
  const PlannedPath path = world.plan(start, goals).value();
  GivenPath given;
  for (const JointVec& q : path.q) given.rows.emplace_back(q.begin(), q.end());
  given.cost = path.cost;
  const PathVerdict sound = verify_path(robot, {}, given, {}).value();
  EXPECT_TRUE(sound.faults.empty()) << sound.faults[0].what;
  EXPECT_GT(sound.clearance, 0);
  EXPECT_NEAR(sound.cost, path.cost, 1e-9);

  given.rows = {given.rows.front(), given.rows.back()};
  Kinds kinds;
  const PathVerdict bent = verify_path(robot, {}, given, {}).value();
  for (const PathFault& fault : bent.faults) {
    kinds.push_back(fault.kind);
  }
  EXPECT_EQ(kinds, (Kinds{"hit", "contact", "cost"}));
}

TEST_F(VerifyPathTest, WorkIsBounded) {
  const std::string id = "crane/open/0";
  // 40 million samples, or 1e300: neither is begun.
  EXPECT_EQ(faults(id, {{-1, 0}, {2e5, 0}, {1, 0}}), Kinds{"limits"});
  const std::string in = folder_.write("problems.json", problems_.dump()).string();
  const ProblemFile file = read_problem_file(in).value();
  GivenPath path;
  path.id = id;
  path.rows = {{-1, 0}, {1, 0}};
  for (const double step : {1e-300, 0.0, -1.0, std::nan("")}) {
    EXPECT_FALSE(verify_path(file, file.problems.front(), path, {.step = step})) << step;
  }
  GivenPath long_way;
  long_way.id = id;
  for (int i = 0; i < 20'000; ++i) long_way.rows.push_back({i % 2 == 0 ? -1.0 : 1.0, 0});
  const auto found = verify_path(file, file.problems.front(), long_way, {.step = 1e-4});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->faults.front().kind, std::string("length"));
}

}  // namespace
}  // namespace mjarm
