// Plans written and read again, and files that are none.
#include "mjarm/planning/plan_file.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/planning/plan_answer.hpp"
#include "mjarm/planning/two_problems_test.hpp"
#include "mjarm/planning/verify_path.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using nlohmann::json;

class PlanFileTest : public ::testing::Test {
 protected:
  Result<std::vector<GivenPath>> read(const std::string& content) {
    return read_plan_file(folder_.write("paths.json", content).string(), 2);
  }
  /// A sound entry with one thing changed.
  Result<std::vector<GivenPath>> read_with(const char* place, const json& value) {
    json entry = {
        {"ok", true},
        {"path", {{-1, 0}, {1, 0}}},
        {"tilt", {{"limit", 0.1}, {"largest", 0.05}, {"tool", {0, 0, 1}}, {"world", {0, 0, -1}}}},
        {"hold", {"cup"}},
        {"allow", {"cup,table"}}};
    if (*place != '\0') entry[json::json_pointer(place)] = value;
    return read(json{{"id", entry}}.dump());
  }
  void expect_refused(const std::string& content, const std::string& word) {
    const auto file = read(content);
    ASSERT_FALSE(file) << content;
    EXPECT_EQ(file.error().code, Errc::bad_input);
    EXPECT_NE(file.error().what.find("paths.json"), std::string::npos) << file.error().what;
    EXPECT_NE(file.error().what.find(word), std::string::npos) << file.error().what;
  }

  LanguageScope english_{Language::english};
  support::TempFolder folder_;
};

/// Every number of an answer comes back as the bits it had, with its certificates and its rules.
TEST_F(PlanFileTest, AnswersAreReadAsTheyWereWritten) {
  const std::string in = folder_.write("problems.json", testing::two_problems().dump()).string();
  const ProblemFile file = read_problem_file(in).value();
  const FastRobot robot = FastRobot::create(file.arm, file.spheres).value();
  const PlanProblem& problem = file.problems[0];
  PlanAnswer answer = answer_problem(robot, problem, {});
  ASSERT_TRUE(answer.path);
  EXPECT_GT(answer.us, 0);
  EXPECT_GT(answer.simplify_us, 0);
  answer.rules = {{"cup \"2\""}, {"cup,table", "a,b"}};
  answer.tilt = TiltLimit{.max = 0.1};
  answer.path->tilt = 0.05;
  TaskRegion region =
      region_about({{1, 2, 3}, rotation_exp({0.1, 0.2, 0.3})}, {kFreePlace, 0.1, 0.2}, 0.3, 1);
  region.X_FT = {{0, 0, 0.5}, rotation_exp({1, 0, 0})};
  region.mechanism = Mechanism{.type = JointType::slide,
                               .p_W = {1, 0, 2},
                               .axis_W = {0.6, 0, -0.8},
                               .min = -0.1,
                               .max = 0.2};
  answer.within = region;
  answer.path->room = {kFreePlace, 0.125};
  answer.path->goal_region = 2;
  std::string text = "{\"round\":";
  append_answer(text, answer, robot, problem.obstacles, true);
  text += '}';
  const GivenPath given = read(text).value().at(0);
  EXPECT_EQ(given.id, "round");
  ASSERT_EQ(given.rows.size(), answer.path->q.size());
  for (std::size_t i = 0; i < given.rows.size(); ++i) {
    EXPECT_EQ(joint_vec(given.rows[i]), answer.path->q[i]);
  }
  EXPECT_EQ(given.cost, answer.path->cost);
  ASSERT_TRUE(given.certificate);
  ASSERT_EQ(given.certificate->size(), answer.path->proof.size());
  for (std::size_t i = 0; i < given.certificate->size(); ++i) {
    const GivenCertificate& one = (*given.certificate)[i];
    EXPECT_EQ(one.step, answer.path->proof[i].step);
    EXPECT_EQ(one.clearance, answer.path->proof[i].nearest.distance);
    EXPECT_EQ(one.t, answer.path->proof[i].nearest_t);
    ASSERT_EQ(one.pair.size(), 2U);
    EXPECT_EQ(one.pair[1], "post");
  }
  EXPECT_EQ(given.rules.hold, answer.rules.hold);
  EXPECT_EQ(given.rules.allow, answer.rules.allow);
  ASSERT_TRUE(given.within);
  EXPECT_EQ(given.within->room.place, kFreePlace);
  EXPECT_EQ(given.within->room.turn, 0.125);
  const TaskRegion& read = given.within->region;
  EXPECT_EQ(read.place_min, region.place_min);
  EXPECT_EQ(read.place_max, region.place_max);
  EXPECT_EQ(read.turn_min, region.turn_min);
  EXPECT_EQ(read.turn_max, region.turn_max);
  EXPECT_EQ(read.lean, region.lean);
  ASSERT_TRUE(read.mechanism);
  EXPECT_EQ(read.mechanism->type, JointType::slide);
  EXPECT_EQ(read.mechanism->p_W, region.mechanism->p_W);
  EXPECT_EQ(read.mechanism->axis_W, region.mechanism->axis_W);
  EXPECT_EQ(read.mechanism->min, -0.1);
  EXPECT_EQ(read.mechanism->max, 0.2);
  const Pose X_WT{{1.2, 2.05, 3}, Eigen::Matrix3d::Identity()};
  EXPECT_NEAR(room_in(read, X_WT).place, room_in(region, X_WT).place, 1e-12);
  EXPECT_NEAR(room_in(read, X_WT).turn, room_in(region, X_WT).turn, 1e-12);
  ASSERT_TRUE(given.tilt);
  EXPECT_EQ(given.tilt->limit, 0.1);
  EXPECT_EQ(given.tilt->largest, 0.05);
  EXPECT_EQ(given.tilt->world, (std::vector<double>{0, 0, -1}));
  // And the verifier agrees with all that was stated.
  GivenPath plain = given;
  plain.tilt.reset();
  plain.within.reset();
  EXPECT_TRUE(verify_path(file, problem, plain, {}).value().faults.empty());
}

TEST_F(PlanFileTest, AnswersWithoutAPathSayWhyAndAreReadAsNone) {
  json content = testing::two_problems();
  content["problems"][0]["start"] = {0, 0};
  const std::string in = folder_.write("problems.json", content.dump()).string();
  const ProblemFile file = read_problem_file(in).value();
  const FastRobot robot = FastRobot::create(file.arm, file.spheres).value();
  const PlanProblem& problem = file.problems[0];
  const PlanAnswer answer = answer_problem(robot, problem, {});
  ASSERT_FALSE(answer.path);
  std::string text;
  append_answer(text, answer, robot, problem.obstacles, false);
  const json written = json::parse(text);
  EXPECT_EQ(written, (json{{"ok", false},
                           {"reason", describe(answer.path.error(), robot, problem.obstacles)}}));
  const GivenPath given = read("{\"round\":" + text + "}").value().at(0);
  EXPECT_TRUE(given.rows.empty());
}

TEST_F(PlanFileTest, BareRowsWillDo) {
  const auto file = read(R"({"b": [[1, 2], [3, 4]], "a": []})").value();
  ASSERT_EQ(file.size(), 2U);
  EXPECT_EQ(file[0].id, "a");
  EXPECT_TRUE(file[0].rows.empty());
  EXPECT_EQ(file[1].rows[1], (std::vector<double>{3, 4}));
  EXPECT_FALSE(file[1].cost || file[1].certificate || file[1].tilt || file[1].rules.any());
}

TEST_F(PlanFileTest, FilesThatAreNoneAreRefusedByTheirPlace) {
  const auto entry = [](const std::string& value) { return "{\"crane/open/0\":" + value + "}"; };
  expect_refused("", "JSON");
  expect_refused("[]", "object");
  expect_refused(entry("[[-1,0],[NaN,0]]"), "JSON");
  expect_refused(entry("[[-1,0],[1e999,0]]"), "range");
  expect_refused(entry("[[-1,0],[null,0]]"), "path[1]");
  expect_refused(entry("[[-1,0],[1,0,0]]"), "path[1]");
  expect_refused(entry("[[-1,0],7]"), "path[1]");
  expect_refused(entry("7"), "crane/open/0");
  expect_refused(entry("{\"ok\":true}"), "\"path\"");
  expect_refused(entry("{\"ok\":1}"), "\"ok\"");
  expect_refused(entry("{\"path\":3}"), "crane/open/0");
  expect_refused(entry("{\"path\":[[-1,0]],\"cost\":\"much\"}"), "\"cost\"");
  expect_refused(entry("{\"path\":[[-1,0]],\"certificate\":4}"), "\"certificate\"");
  expect_refused(entry("{\"path\":[[-1,0]],\"certificate\":[{}]}"), "certificate[0]");
  expect_refused(entry("{\"path\":[[-1,0]],\"certificate\":[{\"step\":1,\"clearance\":1,\"t\":0,"
                       "\"pair\":[1,2]}]}"),
                 "\"pair\"");
  const auto missing = read_plan_file("/no/such.json", 2);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("/no/such.json"), std::string::npos);
}

TEST_F(PlanFileTest, MechanismsThatAreNoneAreRefused) {
  const auto file_with = [](const std::string& mechanism) {
    const std::string pose = R"({"pos":[0,0,0],"quat":[1,0,0,0]})";
    return R"({"id":{"path":[[-1,0]],"within":{"frame":)" + pose + R"(,"tool":)" + pose +
           R"(,"min":[0,0,0,0,0,0],"max":[1,1,1,1,1,1],"lean":1,"room":{"place":0,"turn":0},)" +
           R"("mechanism":)" + mechanism + "}}}";
  };
  const auto member = [](const char* type, const char* axis, const char* max) {
    return std::string(R"({"type":)") + type + R"(,"pos":[0,0,0],"axis":)" + axis +
           R"(,"min":0,"max":)" + max + "}";
  };
  const auto fine = read(file_with(member(R"("hinge")", "[0,0,1]", "1")));
  ASSERT_TRUE(fine) << fine.error().what;
  EXPECT_EQ(fine->at(0).within->region.mechanism->max, 1);
  expect_refused(file_with("3"), "within");
  expect_refused(file_with("{}"), "\"mechanism\" must have");
  expect_refused(file_with(member(R"("door")", "[0,0,1]", "1")), "\"mechanism\" must have");
  expect_refused(file_with(member("1", "[0,0,1]", "1")), "\"mechanism\" must have");
  expect_refused(file_with(member(R"("hinge")", "[0,0,2]", "1")), "\"mechanism\" must have");
  expect_refused(file_with(member(R"("hinge")", "[0,0,1]", "-1")), "\"mechanism\" must have");
  expect_refused(file_with(member(R"("hinge")", "[0,0,1]", "null")), "\"mechanism\" must have");
  expect_refused(file_with(member(R"("hinge")", "[0,1]", "1")), "axis");
}

TEST_F(PlanFileTest, WhatIsStatedMustBePossible) {
  EXPECT_TRUE(read_with("", {}));
  const std::pair<const char*, json> wrong[] = {
      {"/tilt", 3},           {"/tilt/tool", {0, 0, 0}}, {"/tilt/world", {0, 0, 2}},
      {"/tilt/largest", 0.2}, {"/tilt/limit", 2},        {"/tilt/limit", nullptr},
      {"/tilt/limit", -1},    {"/hold", "rod"},          {"/allow", {1, 2}}};
  for (const auto& [place, value] : wrong) {
    const auto file = read_with(place, value);
    ASSERT_FALSE(file) << place << " " << value;
    EXPECT_NE(file.error().what.find("\"id\""), std::string::npos) << file.error().what;
  }
}

}  // namespace
}  // namespace mjarm
