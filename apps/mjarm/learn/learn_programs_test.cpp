#include <numbers>

#include "apps/mjarm/learn/learn_test.hpp"
#include "mjarm/core/os_child_input.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/planning_world.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

class LearnPrograms : public testing::LearnTest {};

std::string own_program(const std::string& name, const std::string& height,
                        const std::string& pos = "[-0.25, -0.6, 0.4]") {
  return "robot: ur5e\nprogram:\n"
         "  - polyline: {points: [[-0.3, -0.4, 0.3], [-0.3, -0.6, 0.3]], euler: [180deg, 0, 0]}\n"
         "  - text: {text: " +
         name + ", pos: " + pos + ", up: [0, 0, 1], height: " + height +
         ", euler: [180deg, 0, 0]}\n";
}

TEST_F(LearnPrograms, Page6LooksForAName) {
  const auto with = [&](const auto&... words) {
    return check_text("6", "own.yaml", own_program(words...));
  };
  const auto own = with("LI", "120mm");
  expect_right(own, "nothing in the way");
  EXPECT_EQ(own.out.find("another plane"), std::string::npos) << own.out;
  EXPECT_NE(own.out.find("straight leg of 0.20 m (line 3)"), std::string::npos) << own.out;
  expect_right(with("LI", "100mm"), "try another plane");
  expect_wrong(with("ANNA", "100mm"), "line 4 still writes ANNA");
  expect_wrong(with("LI", "120mm", "[-0.25, -0.6, 1.4]"), "own.yaml:4:");
  expect_wrong(check_text("6", "own.yaml", "robot: ur5e\nprogram:\n  - movej: {joints: home}\n"),
               "it writes nothing");
  expect_refused(check_text("6", "own.yaml", "robot: ur5e\nprogram:\n  - fly: 1\n"), "own.yaml:3:");
}

/// Where the box goes, if anywhere; with a picture or without.
std::string carry(const std::string& box, bool look = false) {
  return std::string("scene: universal_robots_ur5e/pick.xml\nprogram:\n") +
         (look ? "  - look: rgbd\n" : "") +
         "  - pick: can\n  - place: {pos: [0.56, -0.33, 0.256]}\n" + box +
         "  - plan: {joints: home}\n";
}

TEST_F(LearnPrograms, Page7SeesBothCarried) {
  expect_right(check_text("7", "can.yaml",
                          carry("  - pick: box\n  - place: {pos: [0.44, -0.33, 0.236]}\n", true)),
               "two places over the tray, 120 mm apart");
}

TEST_F(LearnPrograms, Page7KnowsWhatIsMissing) {
  const auto alone = check_text("7", "can.yaml", carry(""));
  expect_wrong(alone, "box stays where it is");
  expect_wrong(alone, "put \"- look: rgbd\" before the first \"pick\"");
  expect_wrong(check_text("7", "can.yaml", carry("  - pick: box\n")),
               "box is picked in line 5, but no \"place\" follows");
  const auto same =
      check_text("7", "can.yaml", carry("  - pick: box\n  - place: {pos: [0.55, -0.33, 0.236]}\n"));
  expect_wrong(same, "would be put 10 mm apart");
  expect_wrong(same, "can.yaml:5:");  // and the plan finds no grasp for it
  expect_wrong(
      check_text("7", "can.yaml", carry("  - pick: box\n  - place: {pos: [0.44, 0.33, 0.236]}\n")),
      "beside the tray");
  expect_wrong(check_text("7", "can.yaml", "robot: ur5e\nprogram:\n  - movej: {joints: home}\n"),
               "this scene has no camera");
}

TEST_F(LearnPrograms, Page8MeasuresGravityOverGain) {
  const auto result = run({"check", "8"});
  expect_right(result, "shoulder_lift_joint: -43.15 N m / 2000 N m/rad = -21.58 mrad");
  EXPECT_NE(result.out.find("the tool stays 14.8 mm off"), std::string::npos) << result.out;
}

TEST_F(LearnPrograms, Page9LooksAtATraining) {
  const auto report = [](double share, const char* name = "train reach") {
    return json{{"name", name}, {"steps", 60416}, {"within", {{"2cm", share}, {"5mm", 0.6}}}}
        .dump();
  };
  expect_right(check_text("9", "report.json", report(0.97)), "97.0 % of the goals within 2 cm");
  expect_wrong(check_text("9", "report.json", report(0.1)), "10.0 % of the goals within 2 cm");
  expect_refused(check_text("9", "report.json", report(1, "ellipse")), "no report of a training");
  expect_refused(check_text("9", "report.json", "{\"name\": \"train\"}"),
                 "no report of a training");
}

/// A Python without mjarm and numpy will do: what the checker needs of them stands beside the file.
class LearnPython : public testing::LearnTest {
 protected:
  void SetUp() override {
    if (find_program("python3").empty()) GTEST_SKIP() << "no python3";
    folder_.write("mjarm.py",
                  "class Robot:\n    def __init__(self, name):\n        self.home = [0] * 6\n"
                  "class Pose:\n    def __init__(self, pos, quat):\n        self.pos = pos\n");
    folder_.write("numpy.py", "def array(values):\n    return values\n");
  }
};

TEST_F(LearnPython, Page8CountsWhatASolverSolves) {
  const auto robot = load_robot("ur5e");
  ASSERT_TRUE(robot) << robot.error().what;
  const JointLimits& limits = robot->arm.limits;
  Rng rng(1);  // the checker's own goals
  json known = json::array();
  for (int i = 0; i < 100; ++i) {
    std::vector<double> q;
    for (int j = 0; j < robot->arm.dof(); ++j) {
      q.push_back(rng.uniform(limits.lower[j], limits.upper[j]));
    }
    known.push_back(q);
  }
  const std::string head = "known = iter(" + known.dump() + ")\n";
  const auto with = [&](const std::string& body) {
    return check_text("8", "ik.py", head + body, {"--python", "python3"});
  };
  const auto good = with("def least_squares(robot, goal, q):\n    return next(known, None)\n");
  expect_right(good, "solved 100 of 100 (mjarm: 100)");
  EXPECT_NE(good.out.find("refuses 20 of 20"), std::string::npos) << good.out;
  // A program may end by itself, and the arm need not be given.
  expect_right(with("def least_squares(goal, q):\n    return next(known)\nraise SystemExit(1)\n"),
               "refuses 20 of 20");
  expect_wrong(with("def least_squares(robot, goal, q):\n    return next(known, q)\n"),
               "it answers 20 of 20 poses that nobody can reach");
  const auto none = with("def least_squares(robot, goal, q):\n    return 1 / 0\n");
  expect_wrong(none, "solved 0 of 100");
  EXPECT_NE(none.out.find("ZeroDivisionError"), std::string::npos) << none.out;
  expect_wrong(with("def least_squares(robot, goal, q):\n    return 'six'\n"), "solved 0 of 100");
  expect_wrong(with("def least_squares(robot, goal, q):\n    raise SystemExit(3)\n"), "solved 0");
  expect_refused(with("def other(robot):\n    pass\n"), "no function least_squares");
  expect_refused(with("def least_squares(robot\n"), "SyntaxError");
}

TEST_F(LearnPython, Page9ProvesAPath) {
  const auto robot = load_robot("universal_robots_ur5e/wall.xml");
  ASSERT_TRUE(robot) << robot.error().what;
  auto world = PlanningWorld::create(*robot);
  ASSERT_TRUE(world) << world.error().what;
  const std::vector<double> start{1.9084, -1.2456, 1.9905, -2.3157, -1.5708, 3.4792};
  const auto plan =
      world->plan(start, Pose{{-0.3, -0.45, 0.2}, from_euler({std::numbers::pi, 0, 0})});
  ASSERT_TRUE(plan) << plan.error().what;
  json rows = json::array();
  for (const JointVec& q : plan->q) rows.push_back(std::vector<double>(q.begin(), q.end()));
  const auto with = [&](const std::string& body) {
    return check_text(
        "9", "my_rrt.py",
        "rows = " + rows.dump() + "\ndef plan(robot, start, goal):\n    " + body + "\n",
        {"--python", "python3"});
  };
  const std::string good = "return rows if start[0] == rows[0][0] else rows[::-1]";
  const auto right = with(good);
  expect_right(right, "there: free");
  EXPECT_NE(right.out.find("back: free"), std::string::npos) << right.out;
  expect_wrong(with("return [start, goal]"), "there: edge 0");
  expect_wrong(with("return rows"), "back: the path begins");
  expect_wrong(with("return [start, [x + 0.1 for x in start]]"), "before the goal");
  expect_wrong(with("return None"), "no path (None)");
  expect_wrong(with("return [start, [float('nan')] * 6]"), "nan");
  expect_wrong(with("return [start, goal[:3]]"), "row 1 has 3 values instead of 6");
  expect_wrong(with("return []"), "0 rows");
  expect_wrong(with("return 7"), "no rows of joint values: int");
  expect_refused(with("return [start] * 9000"), "too long");
}

}  // namespace
}  // namespace mjarm::app
