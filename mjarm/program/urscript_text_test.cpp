// The text of exported scripts: what a controller can read, where it stands, and what it follows.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/program/urscript.hpp"
#include "mjarm/program/urscript_check_test.hpp"
#include "mjarm/trajectory/tool_down_test.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kDown;
using testing::kSeed;
using ::testing::Not;
using testing::UrCheck;
using testing::UrReader;
using testing::UrScript;

const Robot& ur5e() {
  static const Robot kRobot = load_robot("ur5e").value();
  return kRobot;
}

ProgramPlan plan_for_script(const Program& program) {
  ProgramPlan plan = plan_program(ur5e().model, ur5e().arm, program);
  EXPECT_TRUE(plan.ok()) << plan.faults.front().what;
  return plan;
}

Program program_of(std::vector<Instruction> instructions) {
  Program program;
  program.name = "cell";
  program.instructions = std::move(instructions);
  return program;
}

Program lap() {
  return program_of({{DrawEllipse{
      .center = {0, -0.45, 0.35}, .a = 0.12, .b = 0.06, .R_FT = kDown, .speed = 0.1}}});
}

/// Statements of one word, and the largest distance of the straight lines between their poses from
/// the curve they stand for.
struct Chords {
  int count = 0;
  double off = 0;  ///< [m]
};

Chords chords_of(const std::string& text, const Curve& curve, const std::string& word) {
  Chords out;
  const UrScript script = UrReader::read(text);
  // The base of the controller is the frame of the world for the shipped model.
  Pose before = curve.at(0);
  for (const testing::UrStatement& statement : script.statements) {
    if (statement.word != word) continue;
    ++out.count;
    const Pose to = testing::ur_pose(statement.lists.at(0));
    for (int i = 0; i <= 20; ++i) {
      const Pose X = interpolate(before, to, i / 20.0);
      out.off = std::max(out.off, curve.nearest(X.p).distance);
    }
    before = to;
  }
  return out;
}

TEST(UrscriptText, AFinerToleranceGivesMorePointsAndEachIsKept) {
  const Program program = lap();
  const ProgramPlan plan = plan_for_script(program);
  int before = 0;
  for (const double tolerance : {3e-3, 1e-3, 1e-4, 1e-5}) {
    const std::string text = to_urscript(program, ur5e(), plan, {.pos_tol = tolerance}).value();
    const Chords chords = chords_of(text, *plan.moves.back().curve, "movep");
    EXPECT_GT(chords.count, before) << tolerance;
    EXPECT_LE(chords.off, tolerance);
    EXPECT_GT(chords.off, 0) << "points of a curve are joined by chords";
    before = chords.count;
    std::smatch told;
    ASSERT_TRUE(std::regex_search(text, told, std::regex("points of curves: within ([0-9.]+) mm")));
    EXPECT_NEAR(std::stod(told[1]), 1e3 * tolerance, 1e-9);
  }
}

/// Controllers read no exponents, no "nan", no tabs, no bytes beyond ASCII; every line ends.
TEST(UrscriptText, IsPlainAsciiWithoutExponents) {
  Program program = program_of({move_j(kSeed), move_j(Pose{{1e-7, -0.45, 0.4}, kDown}),
                                move_l({{0.1, -0.45, 0.4}, kDown * from_euler({1e-9, 0, 0})}, 1e-3),
                                wait(1e-6), wait(0)});
  program.name = "工作 cell\t\r\n";
  const std::string text = to_urscript(program, ur5e(), plan_for_script(program)).value();
  EXPECT_EQ(text.back(), '\n');
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << int{c};
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_THAT(line, Not(::testing::EndsWith(" ")));
    if (line.find('#') != std::string::npos) continue;
    EXPECT_FALSE(std::regex_search(line, std::regex("[0-9]e[-+0-9]|nan|inf"))) << line;
    EXPECT_FALSE(std::regex_search(line, std::regex("-0\\.0[^0-9]"))) << line;
  }
}

/// The same bytes whatever the language of the user is: the pendant shows them to somebody else.
TEST(UrscriptText, DoesNotDependOnTheLanguage) {
  const Program program = program_of({move_j(kSeed), wait(0.5)});
  const ProgramPlan plan = plan_for_script(program);
  const std::string english = to_urscript(program, ur5e(), plan).value();
  const LanguageScope chinese(Language::chinese);
  EXPECT_EQ(to_urscript(program, ur5e(), plan).value(), english);
}

/// Each instruction of the file is named once, in the order of the file, before its statements.
TEST(UrscriptText, EveryInstructionIsFoundByItsLine) {
  const Program program = parse_program(
                              "robot: ur5e\nprogram:\n"
                              "  - movej: {joints: [-1.57, -1.34, 2.65, -1.3, 1.55, 0]}\n"
                              "  - wait: 250ms\n"
                              "  - movej: {pos: [0.1, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
                              "  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0]}\n"
                              "  - movel: {pos: [-0.1, -0.45, 0.4], euler: [180deg, 0, 0]}\n",
                              "p.yaml")
                              .value();
  const ProgramPlan plan = plan_for_script(program);
  const std::string text = to_urscript(program, ur5e(), plan).value();
  std::vector<int> lines;
  const std::regex mark("# line (\\d+): ");
  for (std::sregex_iterator i(text.begin(), text.end(), mark), end; i != end; ++i) {
    lines.push_back(std::stoi((*i)[1]));
  }
  EXPECT_TRUE(std::ranges::is_sorted(lines));
  for (int line = 3; line <= 7; ++line) EXPECT_THAT(lines, ::testing::Contains(line));
  EXPECT_THAT(text, HasSubstr("sleep(0.25)"));
  EXPECT_THAT(text, HasSubstr("# line 7: movel\n  # the tool is there already\n"));
  EXPECT_THAT(UrCheck(UrReader::read(text), plan).problems(), IsEmpty());
}

/// What holds of the plan holds of the script: random programs, statement by statement.
TEST(UrscriptText, RandomProgramsAreTheSameMotion) {
  Rng rng(41);
  for (int round = 0; round < 4; ++round) {
    std::vector<Pose> X(4);
    for (Pose& pose : X) {
      for (int i = 0; i < 3; ++i) {
        constexpr double kLower[] = {-0.25, -0.52, 0.25}, kUpper[] = {0.25, -0.4, 0.45};
        pose.p[i] = rng.uniform(kLower[i], kUpper[i]);
      }
      pose.R = kDown * from_euler({0.1 * rng.normal(), 0, 0.2 * rng.normal()});
    }
    const double blend = rng.uniform(0, 0.02);
    const Program program =
        program_of({move_j(kSeed), move_j(X[0], 0.4), move_l(X[1], 0.1, blend), move_l(X[2], 0.1),
                    wait(0.125 * round), move_l(X[3], 0.05)});
    const ProgramPlan plan = plan_for_script(program);
    const Result<std::string> text = to_urscript(program, ur5e(), plan);
    ASSERT_TRUE(text.has_value()) << text.error().what;
    EXPECT_THAT(UrCheck(UrReader::read(*text), plan).problems(), IsEmpty()) << *text;
  }
}

/// A gripper is a digital output: on before it closes, off before it opens, and time for each.
TEST(UrscriptText, AGripperIsADigitalOutput) {
  ProgramPlan plan = plan_for_script(program_of({wait(1), wait(0.75), wait(0)}));
  plan.moves[0].close = true;
  plan.moves[1].close = false;
  const Program program = program_of({});
  const std::string text = to_urscript(program, ur5e(), plan).value();
  const UrScript script = UrReader::read(text);
  ASSERT_EQ(script.statements.size(), 6U) << text;
  const char* words[] = {
      "set_tcp", "movej", "set_tool_digital_out", "sleep", "set_tool_digital_out", "sleep"};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(script.statements[i].word, words[i]);
  EXPECT_EQ(script.statements[2].numbers, (std::vector<double>{0, 1}));
  EXPECT_EQ(script.statements[4].numbers, (std::vector<double>{0, 0}));
  EXPECT_EQ(script.statements[5].numbers, (std::vector<double>{0.75}));
}

/// An empty plan goes to where it begins, and nowhere else.
TEST(UrscriptText, AnEmptyPlanGoesToItsStart) {
  Program program = program_of({});
  program.start.values = {0.1, -1.2, 1.3, -1.4, -1.5, 0.6};
  const ProgramPlan plan = plan_for_script(program);
  const UrScript script = UrReader::read(to_urscript(program, ur5e(), plan).value());
  ASSERT_EQ(script.statements.size(), 2U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(script.statements[1].lists.at(0)[i], program.start.values[i], 1e-12);
  }
}

/// The names are right, but a link is longer than that of any arm of the maker.
TEST(UrscriptText, AnArmOfOtherLengthsIsRefused) {
  const Program program = program_of({wait(1)});
  const ProgramPlan plan = plan_for_script(program);
  for (const double longer : {0.002, 0.02}) {
    Robot other = ur5e();
    other.arm.joints[2].X_PJ.p.z() += longer;
    const Result<std::string> text = to_urscript(program, other, plan);
    EXPECT_EQ(text.has_value(), longer < 0.003);
    if (text) continue;
    EXPECT_EQ(text.error().code, Errc::impossible);
    EXPECT_THAT(text.error().what, HasSubstr("its axes are where none of theirs has them"));
  }
  Robot renamed = ur5e();
  renamed.arm.joints[3].name = "wrist_1";
  EXPECT_THAT(to_urscript(program, renamed, plan).error().what,
              HasSubstr("no arm of Universal Robots"));
  renamed = ur5e();
  renamed.arm.joints.pop_back();
  EXPECT_THAT(to_urscript(program, renamed, plan).error().what,
              HasSubstr("no arm of Universal Robots"));
}

}  // namespace
}  // namespace mjarm::program
