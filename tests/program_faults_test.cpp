// Motion programs with a planted fault are all caught at the right line; good ones are not refused.
#include <gmock/gmock.h>

#include <regex>

#include "mjarm/program/program_plan.hpp"
#include "mjarm/program/program_reader.hpp"
#include "tests/random_programs.hpp"

namespace mjarm {
namespace {

using testing::RandomProgram;

const Robot& ur5e_scene() {
  static const Robot kRobot = [] {
    program::Program program;
    program.robot = "ur5e";
    return program::load_program_robot(program, "test.yaml").value();
  }();
  return kRobot;
}

program::ProgramPlan plan_of(const program::Program& program) {
  return program::plan_program(ur5e_scene().model, ur5e_scene().arm, program);
}

/// The line in `test.yaml:LINE:COLUMN: ...`.
int line_in(const std::string& message) {
  std::smatch found;
  if (!std::regex_search(message, found, std::regex("^test\\.yaml:(\\d+):\\d+: "))) return -1;
  return std::stoi(found[1]);
}

void expect_caught(const std::string& kind, const RandomProgram& made) {
  SCOPED_TRACE(kind + "\n" + made.text);
  const Result<program::Program> program = program::parse_program(made.text, "test.yaml");
  if (!program) {
    EXPECT_EQ(program.error().code, Errc::bad_input);
    EXPECT_EQ(line_in(program.error().what), made.line) << program.error().what;
    EXPECT_TRUE(made.reasons.empty() || made.reasons.front() == "unknown_name")
        << program.error().what;
    return;
  }
  const program::ProgramPlan plan = plan_of(*program);
  ASSERT_EQ(plan.faults.size(), 1U);
  const program::ProgramFault& fault = plan.faults.front();
  EXPECT_EQ(fault.place.line, made.line) << fault.what;
  EXPECT_THAT(made.reasons, ::testing::Contains(fault.reason)) << fault.what;
  EXPECT_FALSE(fault.what.empty());
}

/// Six programs of each of nine classes.
class PlantedFaults : public ::testing::TestWithParam<std::string> {};

TEST_P(PlantedFaults, AreCaughtAtTheirLine) {
  constexpr int kPrograms = 6;
  Rng rng(2026);
  for (int i = 0; i < kPrograms; ++i) {
    expect_caught(GetParam(), testing::faulty_program(GetParam(), rng));
  }
}

INSTANTIATE_TEST_SUITE_P(Classes, PlantedFaults, ::testing::ValuesIn(testing::fault_classes()),
                         [](const auto& entry) {
                           std::string name = entry.param;
                           std::erase(name, ' ');
                           return name;
                         });

/// Ten programs of each of five seeds.
class GoodPrograms : public ::testing::TestWithParam<int> {};

TEST_P(GoodPrograms, AreNotRefused) {
  constexpr int kPrograms = 10;
  Rng rng(2027 + static_cast<std::uint64_t>(GetParam()));
  for (int i = 0; i < kPrograms; ++i) {
    const RandomProgram made = testing::good_program(rng);
    SCOPED_TRACE(made.text);
    const Result<program::Program> program = program::parse_program(made.text, "test.yaml");
    ASSERT_TRUE(program.has_value()) << program.error().what;
    const program::ProgramPlan plan = plan_of(*program);
    for (const program::ProgramFault& fault : plan.faults) {
      ADD_FAILURE() << "line " << fault.place.line << ": " << fault.reason << ": " << fault.what;
    }
    EXPECT_GT(plan.duration(), 0);
    EXPECT_GE(plan.moves.size(), 2U);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, GoodPrograms, ::testing::Range(0, 5));

}  // namespace
}  // namespace mjarm
