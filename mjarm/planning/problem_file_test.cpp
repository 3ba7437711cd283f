// Files of problems as others write them: what is sound is answered, all else is one line.
#include "mjarm/planning/problem_file.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <functional>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/planning/plan_answer.hpp"
#include "mjarm/planning/two_problems_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using nlohmann::json;
using testing::two_problems;

class ProblemFileTest : public ::testing::Test {
 protected:
  Result<ProblemFile> read(const std::string& content, Cylinders cylinders = Cylinders::replaced) {
    return read_problem_file(folder_.write("problems.json", content).string(), cylinders);
  }
  /// The error of a file that is not sound; it begins with the file's name.
  std::string refusal(const std::string& content) {
    const Result<ProblemFile> file = read(content);
    if (file) {
      ADD_FAILURE() << content.substr(0, 200);
      return "";
    }
    EXPECT_EQ(file.error().code, Errc::bad_input);
    EXPECT_NE(file.error().what.find("problems.json: "), std::string::npos);
    return file.error().what;
  }
  /// The first problem solved.
  PlanAnswer answer(const json& content) {
    file_ = read(content.dump()).value();
    return answer_problem(robot(), file_.problems[0], {});
  }
  /// Why it has no path.
  std::string reason(const json& content) {
    const PlanAnswer found = answer(content);
    if (found.path) return "";
    return describe(found.path.error(), robot(), file_.problems[0].obstacles);
  }
  FastRobot robot() { return FastRobot::create(file_.arm, file_.spheres).value(); }

  LanguageScope english_{Language::english};
  support::TempFolder folder_;
  ProblemFile file_;
};

json box(const std::string& name, double x, double y, double half) {
  return {{"name", name},
          {"type", "box"},
          {"pos", {x, y, 0}},
          {"quat", {1, 0, 0, 0}},
          {"half", {half, half, half}}};
}

json one_problem() {
  json file = two_problems();
  file["problems"].erase(1);
  return file;
}

TEST_F(ProblemFileTest, IsReadAsItStands) {
  json content = two_problems();
  content["problems"][1]["goals"].push_back({-1.0, 0.5});
  content["problems"][1]["scene"] = "shelf";
  content["problems"][1]["valid"] = false;
  const ProblemFile file = read(content.dump()).value();
  EXPECT_EQ(file.arm.name, "flat");
  ASSERT_EQ(file.arm.dof(), 2);
  EXPECT_EQ(file.arm.joints[1].X_PJ.p, Eigen::Vector3d(0.5, 0, 0));
  EXPECT_EQ(file.arm.limits.upper[1], 2.9);
  ASSERT_EQ(file.spheres.links.size(), 2U);
  EXPECT_EQ(file.spheres.size(), 10U);
  ASSERT_EQ(file.problems.size(), 2U);
  EXPECT_TRUE(file.problems[0].valid);
  const PlanProblem& problem = file.problems[1];
  EXPECT_EQ(problem.id, "straight");
  EXPECT_EQ(problem.scene, "shelf");
  EXPECT_FALSE(problem.valid);
  EXPECT_EQ(problem.start, (std::vector<double>{0.8, 0}));
  ASSERT_EQ(problem.goals.size(), 2U);
  EXPECT_EQ(problem.goals[1], JointVec(Eigen::Vector2d(-1, 0.5)));
  ASSERT_EQ(problem.obstacles.solids.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<CapsuleShape>(problem.obstacles.solids[0].shape));
}

TEST_F(ProblemFileTest, CylindersAsTheyAreOrReplaced) {
  json content = one_problem();
  json& post = content["problems"][0]["obstacles"][0];
  const auto shape = [&](Cylinders how) {
    return read(content.dump(), how).value().problems[0].obstacles.solids[0].shape;
  };
  const auto exact = std::get<CylinderShape>(shape(Cylinders::exact));
  EXPECT_EQ(exact.radius, 0.05);
  EXPECT_EQ(exact.half_length, 0.3);
  EXPECT_EQ(std::get<CapsuleShape>(shape(Cylinders::replaced)).half_length, 0.3);
  post["vamp_as"] = "box";
  EXPECT_EQ(std::get<BoxShape>(shape(Cylinders::replaced)).half, Eigen::Vector3d(0.05, 0.05, 0.3));
  post.erase("vamp_as");
  EXPECT_TRUE(std::holds_alternative<CylinderShape>(shape(Cylinders::replaced)));
}

TEST_F(ProblemFileTest, PackedAndPlainAreTheSame) {
  const std::string packed = (folder_.path() / "packed.json.gz").string();
  const std::string content = two_problems().dump();
  const gzFile out = gzopen(packed.c_str(), "wb");
  ASSERT_NE(out, nullptr);
  ASSERT_EQ(gzwrite(out, content.data(), static_cast<unsigned>(content.size())),
            static_cast<int>(content.size()));
  ASSERT_EQ(gzclose(out), Z_OK);
  const ProblemFile plain = read(content).value(), unpacked = read_problem_file(packed).value();
  ASSERT_EQ(plain.problems.size(), unpacked.problems.size());
  EXPECT_EQ(plain.problems[0].start, unpacked.problems[0].start);
  // The first bytes of a packed file, and then something else.
  const auto damaged =
      read_problem_file(folder_.write("damaged.gz", "\x1f\x8b\x08 no packed data").string());
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().what.find("damaged.gz"), std::string::npos);
  const auto missing = read_problem_file("no/such/file.json");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().what, "no/such/file.json: cannot be opened");
}

struct Fault {
  const char* name;
  std::function<void(json&)> plant;
  std::vector<std::string> says;  ///< all of them in the one line
};

class ProblemFileFaults : public ProblemFileTest, public ::testing::WithParamInterface<Fault> {};

TEST_P(ProblemFileFaults, OneLineNamesTheElement) {
  json file = two_problems();
  GetParam().plant(file);
  const std::string line = refusal(file.dump());
  EXPECT_EQ(line.find('\n'), std::string::npos);
  for (const std::string& part : GetParam().says) {
    EXPECT_NE(line.find(part), std::string::npos) << part << "\n" << line;
  }
}

const std::vector<Fault> kFaults{
    {"NoRobot", [](json& f) { f.erase("robot"); }, {"\"robot\" is missing"}},
    {"RobotMisspelt",
     [](json& f) {
       f["robto"] = f["robot"];
       f.erase("robot");
     },
     {"\"robot\" is missing", "robto"}},
    {"ProblemsNoList", [](json& f) { f["problems"] = 3; }, {"\"problems\" must be a list"}},
    {"JointType",
     [](json& f) { f["robot"]["joints"][1]["type"] = "hinge"; },
     {"robot: joints[1]", "\"hinge\"", "revolute"}},
    {"UnknownParent",
     [](json& f) { f["robot"]["joints"][1]["parent"] = "uper"; },
     {"joints[1]", "\"uper\"", "upper"}},
    {"LinkTwice",
     [](json& f) { f["robot"]["joints"][1]["child"] = "upper"; },
     {"joints[1]", "\"upper\""}},
    {"Branch",
     [](json& f) { f["robot"]["joints"][1]["parent"] = "base"; },
     {"joints[1]", "one chain"}},
    {"NoAxis",
     [](json& f) { f["robot"]["joints"][0]["axis"] = {0, 0, 0}; },
     {"joints[0]", "\"axis\""}},
    {"Limits",
     [](json& f) { f["robot"]["joints"][0]["limits"] = {1, -1}; },
     {"joints[0]", "\"limits\""}},
    {"NoRadius",
     [](json& f) { f["robot"]["spheres"][3].erase("radius"); },
     {"spheres[3]", "\"radius\""}},
    {"RadiusZero", [](json& f) { f["robot"]["spheres"][3]["radius"] = 0; }, {"upper"}},
    {"SphereLink",
     [](json& f) { f["robot"]["spheres"][3]["link"] = 7; },
     {"spheres[3]", "\"link\" must be a string"}},
    {"PairOfOne",
     [](json& f) { f["robot"]["self_collision_link_pairs"] = {{"upper"}}; },
     {"self_collision_link_pairs[0]", "two links"}},
    {"StartLength", [](json& f) { f["problems"][1]["start"] = {1}; }, {"problems[1]", "\"start\""}},
    {"StartNull",
     [](json& f) { f["problems"][1]["start"] = {nullptr, 1}; },
     {"problems[1]", "\"start\""}},
    {"GoalText",
     [](json& f) { f["problems"][0]["goals"][0] = json::array({"a", "b"}); },
     {"problems[0]", "goals[0]"}},
    {"IdTwice", [](json& f) { f["problems"][1]["id"] = "round"; }, {"problems[1]", "\"round\""}},
    {"ObstacleType",
     [](json& f) { f["problems"][0]["obstacles"][0]["type"] = "cylindre"; },
     {"problems[0]", "obstacles[0]", "cylindre", "cylinder"}},
    {"ObstacleTurn",
     [](json& f) { f["problems"][0]["obstacles"][0]["quat"] = {0, 0, 0, 0}; },
     {"problems[0]", "obstacles[0]"}},
    {"ObstacleSizeZero",
     [](json& f) { f["problems"][0]["obstacles"][0]["radius"] = 0; },
     {"problems[0]", "post"}},
    {"ObstacleFarAway",
     [](json& f) { f["problems"][0]["obstacles"][0]["pos"] = {1e300, 0, 0}; },
     {"problems[0]", "post"}},
    {"Replacement",
     [](json& f) { f["problems"][0]["obstacles"][0]["vamp_as"] = "cone"; },
     {"obstacles[0]", "\"cone\""}},
};
INSTANTIATE_TEST_SUITE_P(All, ProblemFileFaults, ::testing::ValuesIn(kFaults),
                         [](const auto& param) { return param.param.name; });

TEST_F(ProblemFileTest, NumbersThatAreNone) {
  const std::string sound = one_problem().dump(), start = "\"start\":[0.8,0.0]";
  ASSERT_NE(sound.find(start), std::string::npos);
  for (const char* wrong :
       {"[NaN,0.0]", "[1e999,0.0]", "[-Infinity,0]", "[null,0]", "[\"0.8\",0]"}) {
    std::string content = sound;
    content.replace(content.find(start), start.size(), std::string("\"start\":") + wrong);
    EXPECT_FALSE(refusal(content).empty()) << wrong;
  }
}

TEST_F(ProblemFileTest, NestingWithoutEndAndTextThatBreaksOff) {
  for (const std::string& content :
       {std::string(1'000'000, '['), "{\"robot\":" + std::string(500'000, '{'),
        std::string("{\"robot\":"), std::string(), std::string("[]")}) {
    EXPECT_LT(refusal(content).size(), 400U);
  }
}

TEST_F(ProblemFileTest, AHundredThousandObstaclesAreSolvedAndTwiceAsManyRefused) {
  json content = one_problem();
  const double alone = answer(content).path.value().cost;
  Rng rng(3);
  json& obstacles = content["problems"][0]["obstacles"];
  // Thick beyond the reach, and a heap in place of the post.
  while (obstacles.size() < 50'000) {
    const double x = rng.uniform(-20, 20), y = rng.uniform(-20, 20);
    if (x * x + y * y > 2) obstacles.push_back(box("far", x, y, 0.01));
  }
  while (obstacles.size() < 100'000) {
    obstacles.push_back(box("heap", rng.uniform(0.66, 0.74), rng.uniform(-0.04, 0.04), 0.005));
  }
  const PlanAnswer found = answer(content);
  ASSERT_TRUE(found.path);
  EXPECT_GT(found.path->q.size(), 2U);
  EXPECT_NEAR(found.path->cost, alone, 2.0);
  obstacles = json(200'001, box("same", 5, 5, 0.1));
  EXPECT_NE(refusal(content.dump()).find("200001"), std::string::npos);
}

TEST_F(ProblemFileTest, EndsThatCannotBeAreTold) {
  const auto with = [](const char* key, const json& value) {
    json content = one_problem();
    content["problems"][0][key] = value;
    return content;
  };
  EXPECT_EQ(reason(with("goals", json::array())),
            "expected one start and at least one goal of 2 finite joint values each");
  EXPECT_EQ(reason(with("start", {0, 0})),
            "the start is in collision: link \"lower\" overlaps obstacle \"post\" by 110.01 mm");
  EXPECT_NE(reason(with("goals", {{0, 0}, {0.1, 0}})).find("every goal is in collision"),
            std::string::npos);
  EXPECT_NE(reason(with("start", {3.5, 0})).find("outside of the limits"), std::string::npos);
  EXPECT_NE(reason(with("goals", {{0, 1e300}})).find("outside of the limits"), std::string::npos);
  EXPECT_NE(reason(with("obstacles", json::array({box("all", 0, 0, 1e4)}))).find("\"all\""),
            std::string::npos);
  json many = json::array();
  Rng rng(5);
  while (many.size() < 100'000) many.push_back({rng.uniform(-1, 1) * 1e-3, 0});
  EXPECT_NE(reason(with("goals", many)).find("every goal is in collision"), std::string::npos);
}

TEST_F(ProblemFileTest, WhatASummaryContradictsIsSaid) {
  json file = one_problem();
  file["robot"]["joint_names"] = {"upper_joint", "lower_joint"};
  file["robot"]["lower"] = {-2.9, -2.9};
  file["robot"]["upper"] = {2.9, 2.9};
  EXPECT_TRUE(read(file.dump()));
  json other = file;
  other["robot"]["joint_names"] = {"lower_joint", "upper_joint"};
  EXPECT_NE(refusal(other.dump())
                .find("robot: \"joint_names\" contradicts the joints, which say "
                      "upper_joint, lower_joint"),
            std::string::npos);
  other = file;
  other["robot"]["upper"] = {2.9, 3.1};
  EXPECT_NE(refusal(other.dump()).find("\"upper\" contradicts"), std::string::npos);
  other = file;
  other["problems"][0]["obstacle"] = json::array();
  EXPECT_NE(refusal(other.dump())
                .find("problems[0]: the key \"obstacle\" is not known here (did "
                      "you mean \"obstacles\"?)"),
            std::string::npos);
}

TEST_F(ProblemFileTest, RobotsThatAreTooMuch) {
  json many = one_problem();
  const json spheres = many["robot"]["spheres"];
  for (int k = 0; k < 100; ++k) {
    for (const json& sphere : spheres) many["robot"]["spheres"].push_back(sphere);
  }
  EXPECT_NE(refusal(many.dump()).find("1010 spheres"), std::string::npos);
  json longest = one_problem();
  std::string before = "lower";
  for (int k = 0; k < 100; ++k) {
    const std::string next = "more" + std::to_string(k);
    longest["robot"]["joints"].push_back(testing::turning_link(next, before, 0.1));
    before = next;
  }
  EXPECT_NE(refusal(longest.dump()).find("joints[16]"), std::string::npos);
}

}  // namespace
}  // namespace mjarm
