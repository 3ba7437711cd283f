#include "mjarm/program/program_reader.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;

constexpr const char* kWhole = R"(# every instruction once
robot: ur5e
tool: attachment_site
frame: table
control: feed_forward
speed: 100mm/s
joint_speed: 0.5
zone: 5mm
frames:
  table: {pos: [0, -0.5, 0.1], euler: [0, 0, 90deg]}
  corner: {pos: [0.1, 0, 0], quat: [1, 0, 0, 0], frame: table}
poses:
  above: {pos: [0, 0, 0.3], euler: [180deg, 0, 0]}
  left: {pos: [0, 0, 0.3], matrix: [[1, 0, 0], [0, -1, 0], [0, 0, -1]], frame: world}
postures:
  ready: [0, -90deg, 1.57, -1.57, -90 deg, 0]
program:
  - movej: {joints: ready, speed: 0.2}
  - movej: above
  - movel: {pose: left, speed: 0.25, blend: 10mm}
  - movec: {via: {pos: [0, 0.1, 0.3], euler: [3, 0, 0]}, to: above, blend: 15mm}
  - ellipse: {center: [0, 0, 0.5], a: 0.3, b: 150mm, normal: [0, 0, 1], euler: [3.14, 0, 0]}
  - circle: {center: [0, 0, 0.5], radius: 0.1, normal: [0, 0, 1], euler: [3.14, 0, 0], frame: corner}
  - circle: {via: above, to: left}
  - polyline: {points: [[0, 0, 0.3], [0, 0.1, 0.3], above], euler: [3.14, 0, 0], blend: 0.02}
  - text: {text: HI 5, pos: [0, 0, 0.3], up: [0, 0, 1], height: 5cm, euler: [3.14, 0, 0]}
  - wait: 500ms
  - set: {tool: attachment_site, frame: world, speed: 0.1, joint_speed: 1, zone: 0}
  - repeat:
      times: 3
      program:
        - plan: {joints: home}
        - grip: close
  - grip: open
)";

template <class What>
const What& nth(const Program& program, std::size_t i) {
  return std::get<What>(program.instructions.at(i).what);
}

TEST(ProgramReader, TakesEveryInstruction) {
  const Result<Program> read = parse_program(kWhole, "whole.yaml");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  const Program& p = *read;
  EXPECT_EQ(p.robot, "ur5e");
  EXPECT_EQ(p.control, ControlMode::feed_forward);
  EXPECT_EQ(p.settings.frame->name, "table");
  EXPECT_EQ(p.settings.speed, 0.1);
  EXPECT_EQ(p.settings.share, 0.5);
  EXPECT_EQ(p.settings.zone, 0.005);
  EXPECT_EQ(p.frames.at("corner").frame.name, "table");
  ASSERT_EQ(p.instructions.size(), 13U);
  EXPECT_EQ(p.instructions[0].place.line, 18);
  EXPECT_EQ(p.instructions[0].place.column, 5);

  const auto& q = std::get<JointValues>(nth<MoveJ>(p, 0).goal).values;
  ASSERT_EQ(q.size(), 6U);
  EXPECT_DOUBLE_EQ(q[1], -std::numbers::pi / 2);
  EXPECT_EQ(nth<MoveJ>(p, 0).share, 0.2);
  EXPECT_TRUE(std::holds_alternative<ProgramPose>(nth<MoveJ>(p, 1).goal));
  EXPECT_EQ(nth<MoveL>(p, 2).goal.frame.name, "world");
  EXPECT_EQ(nth<MoveL>(p, 2).blend, 0.01);
  EXPECT_LT((nth<MoveL>(p, 2).goal.X_FT.R - from_euler({std::numbers::pi, 0, 0})).norm(), 1e-9);
  EXPECT_FALSE(nth<MoveC>(p, 3).whole);
  EXPECT_EQ(nth<MoveC>(p, 3).blend, 0.015);
  EXPECT_EQ(nth<DrawEllipse>(p, 4).b, 0.15);
  EXPECT_EQ(word(p.instructions[5]), "circle");
  EXPECT_EQ(nth<DrawEllipse>(p, 5).frame.name, "corner");
  EXPECT_TRUE(nth<MoveC>(p, 6).whole);
  EXPECT_EQ(nth<DrawPolyline>(p, 7).points.size(), 3U);
  EXPECT_EQ(nth<DrawText>(p, 8).text, "HI 5");
  EXPECT_EQ(nth<DrawText>(p, 8).height, 0.05);
  EXPECT_EQ(nth<DrawText>(p, 8).plane.X_FT.R.col(1), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(nth<Wait>(p, 9).seconds, 0.5);
  EXPECT_EQ(nth<Set>(p, 10).zone, 0);
  EXPECT_EQ(nth<Repeat>(p, 11).body.size(), 2U);
  EXPECT_TRUE(std::get<JointValues>(std::get<PlanMove>(nth<Repeat>(p, 11).body[0].what).goal)
                  .values.empty());
  EXPECT_FALSE(nth<Grip>(p, 12).close);
}

struct Wrong {
  const char* instruction;  ///< what stands after "  - " in line 3
  const char* place;        ///< "line:column"
  const char* words;        ///< part of what is said
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.instruction; }

class WrongInstructions : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongInstructions, AreNamedWithTheirPlace) {
  const Wrong& wrong = GetParam();
  const std::string text = std::string("robot: ur5e\nprogram:\n  - ") + wrong.instruction + "\n";
  const Result<Program> read = parse_program(text, "p.yaml");
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().code, Errc::bad_input);
  EXPECT_THAT(read.error().what,
              ::testing::StartsWith(std::string("p.yaml:") + wrong.place + ": "));
  EXPECT_THAT(read.error().what, HasSubstr(wrong.words));
  EXPECT_EQ(read.error().what.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongInstructions,
    ::testing::Values(
        Wrong{"movell: {}", "3:5", "\"movel\""}, Wrong{"movel: [1, 2]", "3:12", "expected fields"},
        Wrong{"movel: {pos: [1, 2, 3], euler: [0, 0, 0], sped: 1}", "3:47", "\"speed\""},
        Wrong{"movel: {pos: [1, 2], euler: [0, 0, 0]}", "3:18", "3 numbers, got 2"},
        Wrong{"movel: {pos: [1, 2, x], euler: [0, 0, 0]}", "3:25", "\"x\""},
        Wrong{"movel: {pos: [1, 2, 3s], euler: [0, 0, 0]}", "3:25", "unit"},
        Wrong{"movel: {pos: [1, 2, nan], euler: [0, 0, 0]}", "3:25", "nan"},
        Wrong{"movel: {pos: [1, 2, \"3\"], euler: [0, 0, 0]}", "3:25", "number"},
        Wrong{"movel: {pos: [1, 2, 3], euler: [180, 0, 0]}", "3:37", "180deg"},
        Wrong{"movel: {pos: [1, 2, 3]}", "3:12", "orientation is missing"},
        Wrong{"movel: {euler: [1, 2, 3]}", "3:12", "\"pos\" is missing"},
        Wrong{"movel: {pos: [1, 2, 3], quat: [1, 1, 0, 0]}", "3:35", "unit quaternion"},
        Wrong{"movel: {pos: [1, 2, 3], matrix: [1, 0, 0, 0, 1, 0, 0, 0, -1]}", "3:37", "rotation"},
        Wrong{"movel: {pos: [1, 2, 3], quat: [1, 0, 0, 0], euler: [0, 0, 0]}", "3:35", "two"},
        Wrong{"movel: {pose: up}", "3:19", "unknown pose \"up\""},
        Wrong{"movel: {pose: up, pos: [1, 2, 3]}", "3:28", "goes without"},
        Wrong{"movel: {pos: [1, 2, 3], euler: [0, 0, 0], speed: 0}", "3:54", "above 0"},
        Wrong{"movel: {pos: [1, 2, 3], euler: [0, 0, 0], blend: -1}", "3:54", "0 or more"},
        Wrong{"movec: {via: {pos: [1, 2, 3], euler: [0, 0, 0]}, to: {pos: [1, 2, 4], "
              "euler: [0, 0, 0]}, blend: -5mm}",
              "3:101", "0 or more"},
        Wrong{"circle: {via: {pos: [1, 2, 3], euler: [0, 0, 0]}, to: {pos: [1, 2, 4], "
              "euler: [0, 0, 0]}, blend: 5mm}",
              "3:95", "\"blend\""},
        Wrong{"movej: {joints: [1], speed: 50}", "3:33", "share"},
        Wrong{"movej: {joints: hoem}", "3:21", "\"home\""},
        Wrong{"movej: {joints: []}", "3:21", "list of numbers"},
        Wrong{"wait: -1", "3:11", "from 0 to 86400"}, Wrong{"wait: 3kg", "3:11", "kg"},
        Wrong{"grip: closed", "3:11", "\"close\""},
        Wrong{"repeat: {times: 1.5, program: [wait: 1]}", "3:21", "whole number"},
        Wrong{"repeat: {times: 2, program: []}", "3:33", "list of instructions"},
        Wrong{"repeat: {times: 2, program: [wayt: 1]}", "3:34", "\"wait\""},
        Wrong{"polyline: {points: [[1, 2, 3]], euler: [0, 0, 0]}", "3:24", "2 points"},
        Wrong{"text: {text: A, pos: [0, 0, 0], right: [0, 1, 0], euler: [0, 0, 0]}", "3:11",
              "parallel"},
        Wrong{"wait", "3:5", "one instruction"}, Wrong{"{wait: 1, grip: open}", "3:5", "one"},
        Wrong{"wait: 1\n    wait: 2", "4:5", "second time"}, Wrong{"wait: [1", "3:11", "YAML"},
        Wrong{"wait: *nothing", "3:11", "YAML"}));

std::string error_of(const std::string& text) {
  const Result<Program> read = parse_program(text, "p.yaml");
  return read ? "none" : read.error().what;
}

TEST(ProgramReader, NamesWhatIsMissingAtTheTop) {
  EXPECT_THAT(error_of(""), HasSubstr("p.yaml:1:1: "));
  EXPECT_THAT(error_of("program: [wait: 1]"), HasSubstr("\"robot\" is missing"));
  EXPECT_THAT(error_of("robot: ur5e"), HasSubstr("\"program\" is missing"));
  EXPECT_THAT(error_of("robots: ur5e\nprogram: [wait: 1]"), HasSubstr("\"robot\""));
  EXPECT_THAT(error_of("robot: ur5e\ncontrol: computed\nprogram: [wait: 1]"),
              HasSubstr("p.yaml:2:10"));
  EXPECT_THAT(error_of("robot: ur5e\nframes: {world: {pos: [0, 0, 0], quat: [1, 0, 0, 0]}}\n"
                       "program: [wait: 1]"),
              HasSubstr("p.yaml:2:10"));
  EXPECT_THAT(error_of("robot: ur5e\nprogram: [wait: 1]\n---\nrobot: ur5e\n"),
              HasSubstr("one document"));
  EXPECT_THAT(error_of("just words"), HasSubstr("expected fields"));
}

TEST(ProgramReader, IsBoundedWhateverTheFileHolds) {
  EXPECT_THAT(error_of(std::string(100000, '[')), HasSubstr("levels"));
  EXPECT_THAT(error_of("a: " + std::string(100000, '{')), HasSubstr("p.yaml:1:"));
  // Each name holds ten times what the one before holds.
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += before + (k < 9 ? ", " : "]\n");
  }
  EXPECT_THAT(error_of(bomb), HasSubstr("more than 200000"));
  std::string many = "robot: ur5e\nprogram:\n";
  for (int i = 0; i < 120000; ++i) many += "  - wait: 1\n";
  EXPECT_THAT(error_of(many), HasSubstr("more than 200000"));
  EXPECT_NE(error_of(std::string("robot: \0\xff\xfe", 10)), "none");
}

TEST(ProgramReader, ReadsAFileAndTakesItsName) {
  const support::TempFolder folder;
  const auto file = folder.write("my_cell.yaml", "robot: ur5e\nprogram: [wait: 1]\n");
  const Result<Program> read = read_program(file);
  ASSERT_TRUE(read.has_value()) << read.error().what;
  EXPECT_EQ(read->name, "my_cell");
  EXPECT_FALSE(read_program(folder.path() / "none.yaml").has_value());
}

}  // namespace
}  // namespace mjarm::program
