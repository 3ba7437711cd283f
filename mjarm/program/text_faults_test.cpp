// All that is wrong with a text is found in one run.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/program/program_reader.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// `line:column what`, one a fault.
std::vector<std::string> faults_in(const std::string& text) {
  std::vector<std::string> out;
  const ProgramText read = look_through(text);
  for (const TextFault& fault : read.faults) {
    out.push_back(std::to_string(fault.place.line) + ":" + std::to_string(fault.place.column) +
                  " " + fault.what);
  }
  return out;
}

TEST(TextFaults, AreAllFoundInOneRun) {
  EXPECT_THAT(faults_in("robot: ur5e\n"
                        "sped: 0.2\n"
                        "joint_speed: 50\n"
                        "frames: {table: {pos: [0, 0], euler: [0, 0, 0]}}\n"
                        "program:\n"
                        "  - movell: {pos: [0, -0.4, 0.4], euler: [180deg, 0, 0]}\n"
                        "  - movel: {pos: [0, -0.4, x], rpy: [180deg, 0, 0], blend: -1}\n"
                        "  - wait: 3kg\n"
                        "  - repeat: {times: 1.5, program: [wayt: 1, wait: 1]}\n"
                        "  - grip: closed\n"),
              ElementsAre(HasSubstr("2:1 program: unknown field \"sped\""), HasSubstr("3:14 "),
                          HasSubstr("4:23 frames: table: pos: expected a list of 3"),
                          HasSubstr("6:5 unknown instruction \"movell\""),
                          HasSubstr("7:28 movel: pos: \"x\""),
                          HasSubstr("7:32 movel: unknown field \"rpy\" (did you mean \"euler\"?)"),
                          HasSubstr("7:60 movel: blend: expected 0 or more"), HasSubstr("8:11 "),
                          HasSubstr("9:21 repeat: times"),
                          HasSubstr("9:36 unknown instruction \"wayt\""), HasSubstr("10:11 ")));
}

/// What a fault explains is not told as a second one.
TEST(TextFaults, AMisspeltFieldIsNotMissedAsWell) {
  EXPECT_THAT(faults_in("robot: ur5e\nprogram:\n  - movel: {pso: [0, 0, 1], euler: [0, 0, 0]}\n"),
              ElementsAre(HasSubstr("\"pso\" (did you mean \"pos\"?)")));
  EXPECT_THAT(faults_in("robot: ur5e\nprogram:\n  - movel: {colour: red, euler: [0, 0, 0]}\n"),
              ElementsAre(HasSubstr("\"colour\""), HasSubstr("movel: \"pos\" is missing")));
  // A pose that cannot be read is known by its name all the same.
  EXPECT_THAT(faults_in("robot: ur5e\nposes: {up: {pos: [0, 0], euler: [0, 0, 0]}}\n"
                        "program: [movel: up, movel: up]\n"),
              SizeIs(1));
}

TEST(TextFaults, OfASoundTextAreNone) {
  EXPECT_THAT(faults_in("robot: ur5e\nprogram: [movej: {joints: home}]\n"), IsEmpty());
  EXPECT_THAT(faults_in("robot: [\n"), ElementsAre(HasSubstr("no YAML")));
}

TEST(TextFaults, EndAfterAHundred) {
  std::string text = "robot: ur5e\nprogram:\n";
  for (int i = 0; i < 1000; ++i) text += "  - wayt: 1\n";
  EXPECT_THAT(faults_in(text), SizeIs(100));
}

TEST(TextFaults, OneLineTellsTheFirstAndHowManyFollow) {
  const auto read = parse_program("robot: ur5e\nprogram: [wayt: 1, movell: up]\n", "p.yaml");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("p.yaml:2:11: unknown instruction \"wayt\""));
  EXPECT_THAT(read.error().what, HasSubstr("(and 1 more)"));
}

TEST(TextFaults, NamesOfTheRobotAreLookedAtInTheSameRun) {
  const support::TempFolder folder;
  const auto faults = [&](const std::string& text) {
    const auto file = folder.write("p.yaml", text);
    std::vector<std::string> out;
    const auto found = find_text_faults(file).value();
    for (const ProgramFault& fault : found) {
      out.push_back(std::to_string(fault.place.line) + " " + fault.what);
    }
    return out;
  };
  EXPECT_THAT(
      faults("robot: ur5e\nprogram:\n  - wayt: 1\n  - movej: {joints: [0, 0]}\n"
             "  - set: {frame: tabel}\n  - movej: {joints: [0, 0, 0, 0, 5cm, 90]}\n"),
      ElementsAre(HasSubstr("3 unknown instruction"), HasSubstr("4 expected 6 joint values, got 2"),
                  HasSubstr("5 "), HasSubstr("6 joint wrist_2_joint turns: an angle is needed")));
  EXPECT_THAT(faults("robot: ur5\nprogram: [wayt: 1]\n"),
              ElementsAre(HasSubstr("1 "), HasSubstr("2 unknown instruction")));
  EXPECT_THAT(faults("robot: ur5\nprogram: [wait: 1]\n"), IsEmpty());
}

}  // namespace
}  // namespace mjarm::program
