// What stands in a program file: every refusal by its whole line, every unit, fields in any order.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/program/program_reader.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// What is said about a text; empty where it is taken.
std::string refusal(const std::string& text) {
  const Result<Program> read = parse_program(text, "p.yaml");
  if (!read) {
    EXPECT_EQ(read.error().code, Errc::bad_input) << text;
    EXPECT_EQ(read.error().what.find('\n'), std::string::npos) << "one line: " << text;
  }
  return read ? "" : read.error().what;
}

/// A head, then one instruction in line 3 that is right.
std::string with_head(const std::string& line) {
  return "robot: ur5e\n" + line + "\nprogram: [wait: 1]\n";
}

/// An instruction, in line 3 from column 5 on.
std::string with_instruction(const std::string& instruction) {
  return "robot: ur5e\nprogram:\n  - " + instruction + "\n";
}

template <class What>
What only(const std::string& instruction) {
  const Result<Program> read = parse_program(with_instruction(instruction), "p.yaml");
  EXPECT_TRUE(read.has_value()) << instruction << ": " << read.error().what;
  return read ? std::get<What>(read->instructions.at(0).what) : What{};
}

struct Refused {
  const char* part;  ///< of the file
  const char* line;  ///< all that is said, without the name of the file
};

TEST(ProgramWords, EveryFaultOfTheHeadHasItsOwnLine) {
  const Refused heads[] = {
      {"robot2: ur5e", "2:1: program: unknown field \"robot2\" (did you mean \"robot\"?)"},
      {"gripper: hand",
       "2:1: program: unknown field \"gripper\"; expected: robot, scene, tool, start, frame, "
       "frames, poses, postures, speed, joint_speed, zone, branch, payload, control, contact, "
       "program"},
      {"scene: [a, b]", "2:8: scene: expected a word"},
      {"tool: \"\"", "2:7: tool: expected a word"},
      {"frame: {pos: [0, 0, 0]}", "2:8: program: frame: expected a word"},
      {"speed: 101", "2:8: program: speed: expected above 0 and at most 100, got 101"},
      {"speed: 0mm/s", "2:8: program: speed: expected above 0 and at most 100, got 0"},
      {"speed: 5m",
       "2:8: program: speed: unknown unit \"m\" in \"5m\" (known here: m/s, cm/s, "
       "mm/s)"},
      {"joint_speed: 1.01",
       "2:14: program: joint_speed: expected a share of the joint limits, above 0 and at most 1, "
       "got 1.01"},
      {"joint_speed: 50%",
       "2:14: program: joint_speed: no unit is expected here, but \"%\" stands in \"50%\""},
      {"zone: -1um", "2:7: program: zone: expected 0 or more, got -1e-06"},
      {"control: servos", "2:10: there is no way of control \"servos\""},
      {"start: hom", "2:8: start: unknown posture \"hom\" (did you mean \"home\"?)"},
      {"start: {joints: home}", "2:8: start: expected a list of numbers"},
      {"frames: [table]", "2:9: frames: expected fields, as in {pos: [...], euler: [...]}"},
      {"poses: up", "2:8: poses: expected fields, as in {pos: [...], euler: [...]}"},
      {"postures: 3", "2:11: postures: expected fields, as in {pos: [...], euler: [...]}"},
      {"frames: {table: {pos: [0, 0, 0]}}",
       "2:17: frames: table: the tool's orientation is missing: euler, quat or matrix"},
      {"frames: {table: {pos: [0, 0, 0], quat: [1, 0, 0, 0], pose: up}}",
       "2:54: frames: table: unknown field \"pose\" (did you mean \"pos\"?)"},
      {"frames: {world: {pos: [0, 0, 0], quat: [1, 0, 0, 0]}}",
       "2:10: \"world\" is the frame of the loaded file"},
      {"poses: {up: {pos: [0, 0], quat: [1, 0, 0, 0]}}",
       "2:19: poses: up: pos: expected a list of 3 numbers, got 2"},
      {"poses: {up: {pos: 3, quat: [1, 0, 0, 0]}}",
       "2:19: poses: up: pos: expected a list of 3 numbers, got 0"},
      {"postures: {up: [0, 1x]}",
       "2:20: postures: up: unknown unit \"x\" in \"1x\" (known here: rad, mrad, deg, m, cm, mm, "
       "um)"},
      {"postures: {up: []}", "2:16: postures: up: expected a list of numbers"},
  };
  for (const Refused& head : heads) {
    EXPECT_THAT(refusal(with_head(head.part)), StartsWith("p.yaml:" + std::string(head.line)))
        << head.part;
  }
}

TEST(ProgramWords, EveryFaultOfAnInstructionHasItsOwnLine) {
  const Refused instructions[] = {
      {"3", "3:5: expected one instruction, as in \"- movel: {...}\""},
      {"[wait: 1]", "3:5: expected one instruction, as in \"- movel: {...}\""},
      {"fly: {}", "3:5: unknown instruction \"fly\""},
      {"MoveL: {}", "3:5: unknown instruction \"MoveL\" (did you mean \"movel\"?)"},
      {"movej: {}", "3:12: movej: \"pos\" is missing"},
      {"movej: {joints: home, frame: world}", "3:34: movej: joints goes without \"frame\""},
      {"movej: {joints: home, quat: [1, 0, 0, 0]}", "3:33: movej: joints goes without \"quat\""},
      {"movel: {joints: home}", "3:13: movel: unknown field \"joints\""},
      {"movel: {pos: [0, 0, 0], matrix: [[1, 0, 0], [0, 1, 0], [0, 0]]}",
       "3:60: movel: matrix: expected a list of 3 numbers, got 2"},
      {"movel: {pos: [0, 0, 0], matrix: [1, 2]}",
       "3:37: movel: matrix: expected a list of 9 numbers, got 2"},
      {"movel: {pos: [0, 0, 0], matrix: [-1, 0, 0, 0, -1, 0, 0, 0, -1]}",
       "3:37: movel: matrix: no rotation matrix"},
      {"movel: {pos: [0, 0, 0], quat: [0, 0, 0, 0]}",
       "3:35: movel: quat: expected a unit quaternion [w, x, y, z], its length is 0"},
      {"movel: {pos: [0, 0, 0], euler: [0, -90, 0]}",
       "3:40: movel: euler: -90 without a unit would be -90 rad, more than a whole turn: write "
       "-90deg, "
       "or -90rad where radians are meant"},
      {"movel: {pos: [0, 1e999, 0], euler: [0, 0, 0]}",
       "3:22: movel: pos: \"1e999\" is not a finite number"},
      {"movel: {pos: [0, -inf, 0], euler: [0, 0, 0]}",
       "3:22: movel: pos: \"-inf\" is not a finite number"},
      {"movel: {pos: [0, !!str 1, 0], euler: [0, 0, 0]}", "3:22: movel: pos: expected a number"},
      {"movec: {via: up, to: up}", "3:18: movec: via: unknown pose \"up\""},
      {"movec: {via: {pos: [0, 0, 0], euler: [0, 0, 0]}}", "3:12: movec: \"to\" is missing"},
      {"movec: {vai: up, to: up}", "3:13: movec: unknown field \"vai\" (did you mean \"via\"?)"},
      {"circle: {center: [0, 0, 0], normal: [0, 0, 1], euler: [0, 0, 0]}",
       "3:13: circle: \"radius\" is missing"},
      {"circle: {center: [0, 0, 0], radius: -5mm, normal: [0, 0, 1], euler: [0, 0, 0]}",
       "3:41: circle: radius: expected above 0 and at most 1e+06, got -0.005"},
      {"circle: {center: [0, 0, 0], via: up}",
       "3:14: circle: unknown field \"center\"; expected: via, to, speed"},
      {"circle: {to: up}", "3:13: circle: \"via\" is missing"},
      {"ellipse: {center: [0, 0, 0], a: 1, b: 1, euler: [0, 0, 0]}",
       "3:14: ellipse: \"normal\" is missing"},
      {"ellipse: {center: [0, 0, 0], a: 1e7m, b: 1, normal: [0, 0, 1], euler: [0, 0, 0]}",
       "3:37: ellipse: a: expected above 0 and at most 1e+06, got 1e+07"},
      {"ellipse: {center: [0, 0, 0], a: 1, b: 1, normal: [0, 0, 1mm], euler: [0, 0, 0]}",
       "3:61: ellipse: normal: no unit is expected here, but \"mm\" stands in \"1mm\""},
      {"polyline: {points: up, euler: [0, 0, 0]}",
       "3:24: polyline: points: expected a list of at least 2 points"},
      {"polyline: {points: [[0, 0, 0], [0, 1, 0]]}",
       "3:15: polyline: the tool's orientation is missing: euler, quat or matrix"},
      {"polyline: {points: [[0, 0, 0], up], euler: [0, 0, 0]}",
       "3:36: polyline: points: unknown pose \"up\""},
      {"text: {text: [A], pos: [0, 0, 0], euler: [0, 0, 0]}", "3:18: text: text: expected a word"},
      {"text: {text: A, pos: [0, 0, 0], up: [0, 0, 0], euler: [0, 0, 0]}",
       "3:11: text: \"right\" and \"up\" are parallel"},
      {"text: {text: A, pos: [0, 0, 0], lift: 0, euler: [0, 0, 0]}",
       "3:43: text: lift: expected above 0 and at most 1e+06, got 0"},
      {"wait: 25h", "3:11: wait: unknown unit \"h\" in \"25h\" (known here: s, ms, us, min)"},
      {"set: {speed: fast}", "3:18: set: speed: \"fast\" is not a number"},
      {"set: {sped: 1}", "3:11: set: unknown field \"sped\" (did you mean \"speed\"?)"},
      {"set: 0.1", "3:10: set: expected fields, as in {pos: [...], euler: [...]}"},
      {"grip: Open",
       "3:11: grip: expected one of open, close, got \"Open\" (did you mean \"open\"?)"},
      {"grip: {open: 1}", "3:11: grip: expected a word"},
      {"plan: {joints: home, speed: 0.5}", "3:26: plan: unknown field \"speed\""},
      {"plan: there", "3:11: plan: unknown pose \"there\""},
      {"repeat: {program: [wait: 1]}", "3:13: repeat: \"times\" is missing"},
      {"repeat: {times: 10001, program: [wait: 1]}",
       "3:21: repeat: times: expected a whole number from 0 to 10000"},
      {"repeat: {times: -1, program: [wait: 1]}",
       "3:21: repeat: times: expected a whole number from 0 to 10000"},
      {"repeat: {times: 2, program: {wait: 1}}",
       "3:33: repeat: program: expected a list of instructions"},
  };
  for (const Refused& wrong : instructions) {
    EXPECT_THAT(refusal(with_instruction(wrong.part)),
                StartsWith("p.yaml:" + std::string(wrong.line)))
        << wrong.part;
  }
}

/// What is deep inside is named where it stands, not where the outermost instruction begins.
TEST(ProgramWords, FaultsInNestedRepeatsHaveTheirOwnLine) {
  EXPECT_THAT(refusal("robot: ur5e\n"
                      "program:\n"
                      "  - repeat:\n"
                      "      times: 2\n"
                      "      program:\n"
                      "        - wait: 1\n"
                      "        - repeat:\n"
                      "            times: 3\n"
                      "            program:\n"
                      "              - movel: {pos: [0, 0, 0], euler: [0, 0, 0],\n"
                      "                        blend: 2s}\n"),
              StartsWith("p.yaml:11:32: movel: blend: unknown unit \"s\" in \"2s\""));
}

TEST(ProgramWords, TheSameFaultIsToldInChineseAtTheSamePlace) {
  const LanguageScope chinese(Language::chinese);
  EXPECT_EQ(refusal(with_instruction("movell: {}")),
            "p.yaml:3:5：没有名为“movell”的指令（是否想输入“movel”？）");
  EXPECT_EQ(refusal(with_instruction("movel: {pos: [0, 0, 0]}")),
            "p.yaml:3:12：movel：缺少工具姿态：euler、quat 或 matrix");
  EXPECT_EQ(refusal(with_instruction("set: {speed: 0}")),
            "p.yaml:3:18：set：speed：应大于 0 且不超过 100，而不是 0");
}

TEST(ProgramWords, NamesAreAnyTextAndOnlyThoseBeforeThemAreKnown) {
  const std::string head = "robot: ur5e\nposes: {\"上 方\": {pos: [0, 0, 1], euler: [0, 0, 0]}}\n";
  const Result<Program> read = parse_program(head + "program: [movel: \"上 方\"]\n", "程序.yaml");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  EXPECT_EQ(std::get<MoveL>(read->instructions[0].what).goal.X_FT.p.z(), 1);
  const Result<Program> wrong = parse_program(head + "program: [movel: 下方]\n", "程序.yaml");
  ASSERT_FALSE(wrong.has_value());
  EXPECT_THAT(wrong.error().what, StartsWith("程序.yaml:3:18: movel: unknown pose \"下方\""));
  // A pose may be that of another one, which stands before it.
  const std::string up = "up: {pos: [0, 0, 1], euler: [0, 0, 0]}", also = "also: {pose: up}";
  EXPECT_EQ(refusal(with_head("poses: {" + up + ", " + also + "}")), "");
  EXPECT_THAT(refusal(with_head("poses: {" + also + ", " + up + "}")),
              HasSubstr("2:22: poses: also: pose: unknown pose \"up\""));
  // A posture that is called home takes the place of the arm's own.
  const Result<Program> home =
      parse_program(with_head("postures: {home: [1, 2]}\nstart: home"), "p.yaml");
  ASSERT_TRUE(home.has_value());
  EXPECT_EQ(home->start.values, (std::vector<double>{1, 2}));
}

TEST(ProgramWords, EveryUnitIsTheSameLengthAngleTimeOrSpeed) {
  for (const char* z : {"0.25", "0.25m", "0.25 m", "25cm", "250mm", "250 mm", "250000um", "2.5e-1",
                        "+0.25", ".25"}) {
    const auto move =
        only<MoveL>("movel: {pos: [0, 0, " + std::string(z) + "], quat: [1, 0, 0, 0]}");
    EXPECT_EQ(move.goal.X_FT.p.z(), 0.25) << z;
  }
  for (const char* angle : {"1.5707963267948966", "90deg", "90 deg", "1570.7963267948966mrad"}) {
    const auto move = only<MoveJ>("movej: {joints: [" + std::string(angle) + "]}");
    EXPECT_NEAR(std::get<JointValues>(move.goal).values.at(0), std::numbers::pi / 2, 1e-15)
        << angle;
  }
  for (const char* time : {"90", "90s", "1.5min", "90000ms", "90000000us"}) {
    EXPECT_EQ(only<Wait>("wait: " + std::string(time)).seconds, 90) << time;
  }
  for (const char* speed : {"0.05", "0.05m/s", "5cm/s", "50mm/s", "50 mm/s"}) {
    EXPECT_EQ(only<Set>("set: {speed: " + std::string(speed) + "}").speed, 0.05) << speed;
  }
}

/// The borders of what is taken: the last number inside each range, and the first one outside.
TEST(ProgramWords, RangesIncludeTheirBorders) {
  EXPECT_EQ(only<Wait>("wait: 0").seconds, 0);
  EXPECT_EQ(only<Wait>("wait: 1440min").seconds, 86400);
  EXPECT_THAT(refusal(with_instruction("wait: 1441min")), HasSubstr("86400, got 86460"));
  EXPECT_EQ(only<Repeat>("repeat: {times: 0, program: [wait: 1]}").times, 0);
  EXPECT_EQ(only<Repeat>("repeat: {times: 1e4, program: [wait: 1]}").times, 10000);
  EXPECT_EQ(only<Set>("set: {joint_speed: 1}").share, 1);
  EXPECT_EQ(only<Set>("set: {speed: 100}").speed, 100);
  EXPECT_EQ(only<Set>("set: {zone: 0}").zone, 0);
  // A whole turn is an angle, more are degrees that lack their unit.
  EXPECT_EQ(refusal(with_instruction("movel: {pos: [0, 0, 0], euler: [720deg, 0, 0]}")), "");
  EXPECT_EQ(refusal(with_instruction("movel: {pos: [0, 0, 0], euler: [6.2832, 0, 0]}")), "");
  EXPECT_EQ(refusal(with_instruction("movel: {pos: [0, 0, 10], euler: [12rad, 0, 0]}")), "");
  EXPECT_THAT(refusal(with_instruction("movel: {pos: [0, 0, 0], euler: [6.3, 0, 0]}")),
              HasSubstr("write 6.3deg"));
  EXPECT_THAT(refusal(with_instruction("movel: {pos: [0, 600, 0], euler: [0, 0, 0]}")),
              HasSubstr("write 600mm"));
}

/// Rounded ones are taken and made exact; the three ways to write a rotation say the same.
TEST(ProgramWords, RotationsAreTheSameHoweverTheyAreWritten) {
  const Eigen::Matrix3d R = from_euler({0.3, -0.5, 1.1});
  const Eigen::Quaterniond q(R);
  char text[400];
  std::snprintf(text, sizeof(text), "quat: [%.5f, %.5f, %.5f, %.5f]", q.w(), q.x(), q.y(), q.z());
  std::vector<std::string> ways{"euler: [0.3, -0.5, 1.1]", text};
  std::snprintf(text, sizeof(text), "quat: [%.5f, %.5f, %.5f, %.5f]", -q.w(), -q.x(), -q.y(),
                -q.z());
  ways.emplace_back(text);
  for (const char* format :
       {"matrix: [%.5f, %.5f, %.5f, %.5f, %.5f, %.5f, %.5f, %.5f, %.5f]",
        "matrix: [[%.5f, %.5f, %.5f], [%.5f, %.5f, %.5f], [%.5f, %.5f, %.5f]]"}) {
    std::snprintf(text, sizeof(text), format, R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2),
                  R(2, 0), R(2, 1), R(2, 2));
    ways.emplace_back(text);
  }
  for (const std::string& way : ways) {
    const Eigen::Matrix3d read = only<MoveL>("movel: {pos: [0, 0, 0], " + way + "}").goal.X_FT.R;
    EXPECT_LT((read - R).norm(), 3e-5) << way;
    EXPECT_LT((read * read.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12) << way;
  }
}

/// One program however its fields stand: in any order, in blocks, with aliases, with CRLF.
TEST(ProgramWords, OrderAndLayoutMakeNoDifference) {
  const std::string fields[] = {"pos: [0.1, 0.2, 0.3]", "euler: [3, 0, 0]", "speed: 0.2",
                                "blend: 10mm", "frame: table"};
  std::vector<std::size_t> order{0, 1, 2, 3, 4};
  int tried = 0;
  do {
    std::string map;
    for (const std::size_t i : order) map += (map.empty() ? "" : ", ") + fields[i];
    const auto move = only<MoveL>("movel: {" + map + "}");
    ASSERT_EQ(move.goal.X_FT.p, Eigen::Vector3d(0.1, 0.2, 0.3));
    ASSERT_EQ(move.goal.X_FT.R, from_euler({3, 0, 0}));
    ASSERT_EQ(move.goal.frame.name, "table");
    ASSERT_EQ(move.speed, 0.2);
    ASSERT_EQ(move.blend, 0.01);
    ++tried;
  } while (std::ranges::next_permutation(order).found);
  EXPECT_EQ(tried, 120);

  const std::string crlf =
      "program:\r\n- movel: &there\r\n    euler: &how [3, 0, 0]\r\n    pos: [0, 0, 1]\r\n"
      "- movel: {pos: [0, 1, 1], euler: *how}\r\n- movel: *there\r\nrobot: ur5e\r\n";
  const Result<Program> read = parse_program(crlf, "p.yaml");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  EXPECT_EQ(read->robot, "ur5e");
  ASSERT_EQ(read->instructions.size(), 3U);
  const auto& first = std::get<MoveL>(read->instructions[0].what).goal.X_FT;
  EXPECT_EQ(std::get<MoveL>(read->instructions[1].what).goal.X_FT.R, first.R);
  EXPECT_EQ(std::get<MoveL>(read->instructions[2].what).goal.X_FT.p, first.p);
  EXPECT_EQ(read->instructions[2].place.line, 6);
  // The same fault is named at the same place.
  EXPECT_THAT(refusal("robot: ur5e\r\nprogram:\r\n  - wayt: 1\r\n"), StartsWith("p.yaml:3:5: "));
}

/// Cut off anywhere, a program is refused at a place inside it or is a shorter one; never a crash.
TEST(ProgramWords, AProgramThatIsCutOffIsRefusedOrShorter) {
  const std::string whole =
      "robot: ur5e\nframes: {table: {pos: [0, -0.5, 0.1], euler: [0, 0, 90deg]}}\n"
      "program:\n  - movel: {pos: [0, 0, 0.3], euler: [3, 0, 0], frame: table}\n"
      "  - repeat: {times: 3, program: [wait: 500ms]}\n  - grip: open\n";
  const auto lines = std::ranges::count(whole, '\n');
  std::size_t refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Result<Program> read = parse_program(whole.substr(0, size), "p.yaml");
    if (read) {
      EXPECT_LE(read->instructions.size(), 3U);
      continue;
    }
    ++refused;
    int line = 0, column = 0;
    ASSERT_EQ(std::sscanf(read.error().what.c_str(), "p.yaml:%d:%d: ", &line, &column), 2)
        << size << ": " << read.error().what;
    EXPECT_TRUE(line >= 1 && line <= lines + 1 && column >= 1) << read.error().what;
  }
  EXPECT_GT(refused, whole.size() / 2);
}

TEST(ProgramWords, AFileThatIsTooLargeOrAFolderIsNoProgram) {
  const support::TempFolder folder;
  const auto large = folder.write("large.yaml", std::string((std::size_t{16} << 20) + 1, '#'));
  const Result<Program> read = read_program(large);
  ASSERT_FALSE(read.has_value());
  EXPECT_THAT(read.error().what, HasSubstr("large.yaml"));
  EXPECT_FALSE(read_program(folder.path()).has_value());
}

/// A value that is left out is missed at its key, not where the next thing stands.
TEST(EmptyValues, AreNamedAtTheirKey) {
  EXPECT_THAT(refusal("robot: ur5e\ntool:\n\n\nprogram: [wait: 1]\n"), StartsWith("p.yaml:2:"));
  EXPECT_THAT(refusal("robot: ur5e\nprogram:\n  - wait:\n  - wait: 1\n"), StartsWith("p.yaml:3:"));
  EXPECT_THAT(refusal("robot: ur5e\nprogram:\n  - wait:\n"), StartsWith("p.yaml:3:"));
  EXPECT_THAT(refusal("robot: ur5e\nprogram:\n"), StartsWith("p.yaml:2:"));
}

}  // namespace
}  // namespace mjarm::program
