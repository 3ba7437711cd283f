// What `set`, frames and names mean: programs that say the same in other words give the same plan.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/letters.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/program_reader.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

const Robot& robot_named(const std::string& name) {
  static std::map<std::string, Robot> loaded;
  if (!loaded.contains(name)) {
    Program program;
    program.robot = name;
    loaded.emplace(name, load_program_robot(program, "").value());
  }
  return loaded.at(name);
}

/// Instructions from line 10 on, whatever the head.
ProgramPlan planned(const std::string& instructions, std::string head = "",
                    const std::string& robot = "ur5e") {
  head = "robot: " + robot + "\n" + head;
  while (std::ranges::count(head, '\n') < 8) head += "\n";
  const Result<Program> program = parse_program(head + "program:\n" + instructions, "p.yaml");
  EXPECT_TRUE(program.has_value()) << program.error().what;
  return plan_program(robot_named(robot).model, robot_named(robot).arm, *program);
}

std::string faults_told(const ProgramPlan& plan) {
  std::string out;
  for (const ProgramFault& fault : plan.faults) {
    out += std::to_string(fault.place.line) + " " + fault.word + " " + fault.reason + ": " +
           fault.what + "\n";
  }
  return out;
}

Pose tool_at(const ProgramPlan& plan, std::size_t i, double share) {
  const PlannedMove& move = plan.moves.at(i);
  const JointVec q = move.trajectory.at(share * move.trajectory.duration()).q;
  return fk(plan.arms[move.tool], as_span(q));
}

void expect_equal_plans(const ProgramPlan& a, const ProgramPlan& b) {
  ASSERT_TRUE(a.ok() && b.ok()) << faults_told(a) << faults_told(b);
  ASSERT_EQ(a.moves.size(), b.moves.size());
  for (std::size_t i = 0; i < a.moves.size(); ++i) {
    EXPECT_EQ(a.moves[i].word, b.moves[i].word);
    EXPECT_NEAR(a.moves[i].trajectory.duration(), b.moves[i].trajectory.duration(), 1e-9) << i;
    for (const double share : {0.0, 0.3, 0.6, 1.0}) {
      const Pose one = tool_at(a, i, share), other = tool_at(b, i, share);
      EXPECT_LT((one.p - other.p).norm(), 1e-8) << i;
      EXPECT_LT((one.R - other.R).norm(), 1e-7) << i;
    }
  }
}

constexpr const char* kSquareOfMoves =
    "  - movej: {pos: [0.1, -0.4, 0.4], euler: [180deg, 0, 0]}\n"
    "  - movel: {pos: [0.1, -0.5, 0.4], euler: [180deg, 0, 0]}\n"
    "  - movel: {pos: [-0.1, -0.5, 0.4], euler: [180deg, 0, 0]}\n"
    "  - movel: {pos: [-0.1, -0.4, 0.4], euler: [180deg, 0, 0]}\n";

TEST(ProgramSettings, PayloadHoldsForWhatFollowsInTheFrameOfTheToolThatIsSet) {
  const ProgramPlan plan = planned(
      "  - wait: 1\n"
      "  - set: {tool: wrist_3_link, payload: {mass: 1.5, com: [0, 20mm, 0]}}\n"
      "  - wait: 1\n"
      "  - set: {payload: 0}\n"
      "  - wait: 1\n",
      "payload: 0.5\n");
  ASSERT_TRUE(plan.ok()) << faults_told(plan);
  ASSERT_EQ(plan.moves.size(), 3u);
  EXPECT_EQ(plan.moves[0].payload, Payload{0.5});
  EXPECT_EQ(plan.moves[1].payload.mass, 1.5);
  const auto point_W = [&](std::size_t tool, const Vector3d& p) {
    return fk(plan.arms[tool], as_span(plan.q_start)) * p;
  };
  EXPECT_LT((point_W(0, plan.moves[1].payload.center) - point_W(1, Vector3d(0, 0.02, 0))).norm(),
            1e-12);
  EXPECT_EQ(plan.moves[2].payload.mass, 0);
}

TEST(ProgramSettings, PayloadsThatAreNoneAreFaultsWithTheirLine) {
  const auto said = [](const std::string& payload) {
    const auto program = parse_program(
        "robot: ur5e\nprogram:\n  - set: {payload: " + payload + "}\n  - wait: 1\n", "p.yaml");
    return program ? std::string() : program.error().what;
  };
  EXPECT_EQ(said("{mass: 2, com: [0, 0, 0.1]}"), "");
  EXPECT_THAT(said("-1"), HasSubstr("p.yaml:3:"));
  EXPECT_THAT(said("-1"), HasSubstr("set: payload: expected from 0 to 1000, got -1"));
  EXPECT_THAT(said("{com: [0, 0, 0]}"), HasSubstr("mass"));
  EXPECT_THAT(said("{mass: 1, cog: [0, 0, 0]}"), HasSubstr("did you mean \"com\""));
  EXPECT_THAT(said("{mass: 1, com: [0, 0]}"), HasSubstr("com"));
}

TEST(ProgramSettings, WhatIsSetIsWhatEachMoveWouldName) {
  const std::string named =
      "  - movej: {pos: [0.1, -0.4, 0.4], euler: [180deg, 0, 0], speed: 0.3}\n"
      "  - movel: {pos: [0.1, -0.5, 0.4], euler: [180deg, 0, 0], speed: 0.07, blend: 12mm}\n"
      "  - movel: {pos: [-0.1, -0.5, 0.4], euler: [180deg, 0, 0], speed: 0.07, blend: 12mm}\n"
      "  - movel: {pos: [-0.1, -0.4, 0.4], euler: [180deg, 0, 0], speed: 0.07}\n";
  const ProgramPlan plan = planned(named);
  EXPECT_EQ(plan.moves.size(), 2U) << "three lines in one motion";
  const std::string set = "speed: 0.07, joint_speed: 0.3, zone: 12mm";
  expect_equal_plans(plan, planned("  - set: {" + set + "}\n" + kSquareOfMoves));
  expect_equal_plans(plan, planned(kSquareOfMoves, "speed: 0.07\njoint_speed: 0.3\nzone: 12mm\n"));
  // The later one holds, and what an instruction names itself goes before both.
  expect_equal_plans(plan, planned("  - set: {speed: 1, joint_speed: 1, zone: 0}\n  - set: {" +
                                   set + "}\n" + kSquareOfMoves));
  expect_equal_plans(
      plan, planned("  - set: {speed: 0.2, joint_speed: 0.9, zone: 1mm}\n" + named, "zone: 3mm\n"));
}

/// A setting in a repeat still holds after it, as if the body stood there as often.
TEST(ProgramSettings, WhatIsSetInARepeatHoldsAfterIt) {
  const std::string moves = kSquareOfMoves;
  expect_equal_plans(planned("  - repeat: {times: 2, program: [set: {speed: 0.05}]}\n" + moves),
                     planned("  - set: {speed: 0.05}\n" + moves));
  expect_equal_plans(planned("  - repeat: {times: 0, program: [set: {speed: 0.05}]}\n" + moves),
                     planned(moves));
}

TEST(ProgramSettings, NamesAreWhatTheyStandFor) {
  const std::string head =
      "poses:\n  over: {pos: [0.1, -0.5, 0.4], euler: [180deg, 0, 0]}\n"
      "  left: {pos: [-0.1, -0.5, 0.4], euler: [180deg, 0, 0]}\n"
      "postures:\n  ready: [-90deg, -77deg, 152deg, -75deg, 89deg, 0]\n  also: ready\n";
  expect_equal_plans(planned("  - movej: {joints: also}\n  - movej: over\n  - movel: left\n", head),
                     planned("  - movej: {joints: [-90deg, -77deg, 152deg, -75deg, 89deg, 0]}\n"
                             "  - movej: {pos: [0.1, -0.5, 0.4], euler: [180deg, 0, 0]}\n"
                             "  - movel: {pos: [-0.1, -0.5, 0.4], euler: [180deg, 0, 0]}\n"));
}

/// The same moves in the world, in a frame that is turned and shifted, and in one within another.
TEST(ProgramSettings, FramesOnlyChangeTheNumbers) {
  const Pose X_WA{{0.05, -0.45, 0.2}, from_euler({0, 0, 0.7})};
  const Pose X_AB{{0.02, 0.03, -0.1}, from_euler({0.2, -0.3, 0.4})};
  const auto numbers = [](const Eigen::VectorXd& v) {
    std::string out;
    char number[40];
    for (const double value : v) {
      std::snprintf(number, sizeof(number), "%s%.15g", out.empty() ? "" : ", ", value);
      out += number;
    }
    return "[" + out + "]";
  };
  const auto pose = [&](const Pose& X, const std::string& more) {
    Eigen::VectorXd matrix(9);
    for (int i = 0; i < 9; ++i) matrix[i] = X.R(i / 3, i % 3);
    return "{pos: " + numbers(X.p) + ", matrix: " + numbers(matrix) + more + "}";
  };
  const Pose targets[] = {{{0.1, -0.4, 0.4}, from_euler({std::numbers::pi, 0, 0})},
                          {{-0.1, -0.5, 0.35}, from_euler({std::numbers::pi, 0.1, 0.2})}};
  const auto moves = [&](const Pose& X_WF, const std::string& more) {
    return "  - movej: " + pose(X_WF.inverse() * targets[0], more) +
           "\n  - movel: " + pose(X_WF.inverse() * targets[1], more) + "\n";
  };
  const std::string frames =
      "frames:\n  a: " + pose(X_WA, "") + "\n  b: " + pose(X_AB, ", frame: a") + "\n";
  const ProgramPlan world = planned(moves({}, ""), frames);
  expect_equal_plans(world, planned(moves(X_WA, ", frame: a"), frames));
  expect_equal_plans(world, planned(moves(X_WA * X_AB, ", frame: b"), frames));
  expect_equal_plans(world, planned(moves(X_WA * X_AB, ""), "frame: b\n" + frames));
  expect_equal_plans(world, planned("  - set: {frame: b}\n" + moves({}, ", frame: world"), frames));
  // A body that stands still is a frame as well; the arm's base is turned by half a turn.
  const Pose X_WBase{{0, 0, 0}, from_euler({0, 0, std::numbers::pi})};
  expect_equal_plans(world, planned(moves(X_WBase, ", frame: base"), frames));
}

TEST(ProgramSettings, ABadHeadIsAFaultAtItsPlaceAndTheRestIsPlanned) {
  const ProgramPlan plan = planned(kSquareOfMoves, "frame: nowhere\n");
  ASSERT_EQ(plan.faults.size(), 1U) << faults_told(plan);
  EXPECT_EQ(plan.faults[0].place.line, 2);
  EXPECT_EQ(plan.faults[0].place.column, 8);
  EXPECT_EQ(plan.faults[0].word, "program");
  EXPECT_EQ(plan.faults[0].code, Errc::bad_input);
  EXPECT_EQ(plan.moves.size(), 4U);
  // Of other joints: the message names the tool.
  EXPECT_THAT(faults_told(planned("  - set: {tool: shoulder_link}\n")),
              HasSubstr("10 set unknown_name: tool \"shoulder_link\" belongs to other joints"));
}

/// An unknown frame in a repeat is one fault, however often it comes by.
TEST(ProgramSettings, AFaultInARepeatIsToldOnce) {
  const ProgramPlan plan = planned(
      "  - repeat:\n      times: 50\n      program:\n"
      "        - movel: {pos: [0, -0.4, 0.4], euler: [3, 0, 0], frame: tabel}\n"
      "        - movel: {pos: [0, -4, 0.4], euler: [3, 0, 0]}\n");
  EXPECT_EQ(plan.faults.size(), 2U) << faults_told(plan);
  EXPECT_THAT(faults_told(plan), HasSubstr("13 movel unknown_name"));
  EXPECT_THAT(faults_told(plan), HasSubstr("14 movel out_of_reach"));
}

TEST(ProgramSettings, CurvesThatCannotBeAreNamedWithWhatIsWrong) {
  const auto why = [](const std::string& instruction) {
    return faults_told(planned("  - " + instruction + "\n"));
  };
  EXPECT_THAT(why("ellipse: {center: [0, -0.4, 0.4], a: 0.1, b: 0.1, normal: [0, 0, 0], "
                  "euler: [3, 0, 0]}"),
              HasSubstr("10 ellipse bad_input"));
  EXPECT_THAT(why("polyline: {points: [[0, -0.4, 0.4], [0, -0.4, 0.4]], euler: [3, 0, 0]}"),
              HasSubstr("10 polyline bad_input"));
  EXPECT_THAT(why("text: {text: A!, pos: [0, -0.4, 0.4], euler: [3, 0, 0]}"),
              ::testing::AllOf(HasSubstr("10 text bad_input"), HasSubstr("!")));
  EXPECT_THAT(why("movel: {pos: [1e7m, -0.4, 0.4], euler: [3, 0, 0]}"), HasSubstr("10 movel"));
  EXPECT_THAT(why("grip: close"), HasSubstr("10 grip not_available"));
}

/// The tool touches the plane on the strokes, and is lifted against its own axis between them.
TEST(ProgramSettings, LettersStandInTheirPlane) {
  const ProgramPlan plan = planned(
      "  - text: {text: TI, pos: [-0.05, -0.45, 0.3], right: [0, 1, 0], up: [-1, 0, 0], "
      "height: 60mm, lift: 15mm, euler: [180deg, 0, 0]}\n");
  ASSERT_TRUE(plan.ok()) << faults_told(plan);
  const std::vector<Stroke> strokes = letter_strokes("TI", 0.06).value();
  const std::vector<PlannedPoint>& points = plan.moves.back().points;
  std::size_t at = 0;
  for (const Stroke& stroke : strokes) {
    ASSERT_LE(at + stroke.points.size() + 2, points.size());
    const auto on_page = [](const Eigen::Vector2d& p) {
      return Vector3d(-0.05 - p.y(), -0.45 + p.x(), 0.3);
    };
    EXPECT_LT((points[at].X_WT.p - on_page(stroke.points.front()) - Vector3d(0, 0, 0.015)).norm(),
              1e-9);
    for (std::size_t k = 0; k < stroke.points.size(); ++k) {
      EXPECT_LT((points[at + 1 + k].X_WT.p - on_page(stroke.points[k])).norm(), 1e-9);
    }
    at += stroke.points.size() + 2;
    EXPECT_LT(
        (points[at - 1].X_WT.p - on_page(stroke.points.back()) - Vector3d(0, 0, 0.015)).norm(),
        1e-9);
  }
  EXPECT_EQ(at, points.size());
}

/// Strokes of our own under the name of a character, in a data folder of their own.
TEST(ProgramSettings, CharactersAreWrittenInSmoothStrokesOnceTheyAreInstalled) {
  const char* before = std::getenv("XDG_DATA_HOME");
  const std::string kept = before != nullptr ? before : "";
  const support::TempFolder folder;
  ::setenv("XDG_DATA_HOME", folder.path().string().c_str(), 1);
  const std::string sentence =
      "  - text: {text: \"上I\", pos: [-0.05, -0.45, 0.3], right: [0, 1, 0], up: [-1, 0, 0], "
      "height: 60mm, lift: 15mm, euler: [180deg, 0, 0]}\n";
  EXPECT_THAT(faults_told(planned(sentence)), HasSubstr("text not_available"));
  folder.write("mjarm/hanzi/strokes.txt", "上 100,900 500,700 900,900 900,100\n");
  const ProgramPlan plan = planned(sentence);
  ASSERT_TRUE(plan.ok()) << faults_told(plan);
  const PlannedMove& move = plan.moves.back();
  EXPECT_TRUE(move.points.empty());
  const Pose lifted{Vector3d(-0.05 - 0.06, -0.45 + 0.06 * 100 / 1024, 0.315), {}};
  EXPECT_LT((move.curve->at(0).p - lifted.p).norm(), 1e-9);
  // Down, a smooth bend up to a corner of 90 degrees and more, up, to the I, down, along it, up.
  EXPECT_EQ(move.curve->corners().size(), 9U);
  const std::vector<Stroke> strokes = letter_strokes("上", 0.06).value();
  for (const Eigen::Vector2d& p : strokes.front().points) {
    EXPECT_LT(move.curve->nearest(Vector3d(-0.05 - p.y(), -0.45 + p.x(), 0.3)).distance, 1e-9);
  }
  kept.empty() ? ::unsetenv("XDG_DATA_HOME") : ::setenv("XDG_DATA_HOME", kept.c_str(), 1);
}

TEST(ProgramSettings, AGripperTakesItsTimeAndIsToldWhichWay) {
  const ProgramPlan plan = planned("  - grip: close\n  - wait: 0\n  - grip: open\n", "", "panda");
  ASSERT_TRUE(plan.ok()) << faults_told(plan);
  ASSERT_EQ(plan.moves.size(), 3U);
  EXPECT_EQ(plan.moves[0].close, true);
  EXPECT_EQ(plan.moves[1].close, std::nullopt);
  EXPECT_EQ(plan.moves[2].close, false);
  EXPECT_EQ(plan.moves[0].trajectory.duration(), plan.moves[2].trajectory.duration());
  EXPECT_GT(plan.moves[0].trajectory.duration(), 0);
  EXPECT_EQ(plan.moves[1].trajectory.duration(), 0);
  EXPECT_EQ(plan.q_end(), robot_named("panda").arm.home);
}

TEST(ProgramSettings, EveryInstructionHasTheWordItIsReadBy) {
  const char* instructions[] = {
      "movej: {joints: home}",
      "movel: {pos: [0, 0, 0], euler: [0, 0, 0]}",
      "movec: {via: {pos: [0, 0, 0], euler: [0, 0, 0]}, to: {pos: [0, 0, 0], euler: [0, 0, 0]}}",
      "ellipse: {center: [0, 0, 0], a: 1, b: 1, normal: [0, 0, 1], euler: [0, 0, 0]}",
      "circle: {center: [0, 0, 0], radius: 1, normal: [0, 0, 1], euler: [0, 0, 0]}",
      "polyline: {points: [[0, 0, 0], [0, 0, 1]], euler: [0, 0, 0]}",
      "text: {text: A, pos: [0, 0, 0], euler: [0, 0, 0]}",
      "wait: 1",
      "set: {speed: 1}",
      "plan: {joints: home}",
      "grip: open",
      "repeat: {times: 1, program: [wait: 1]}"};
  for (const char* instruction : instructions) {
    const Program program =
        parse_program(std::string("robot: ur5e\nprogram:\n  - ") + instruction, "p.yaml").value();
    const std::string_view text(instruction);
    EXPECT_EQ(word(program.instructions.at(0)), text.substr(0, text.find(':')));
  }
}

}  // namespace
}  // namespace mjarm::program
