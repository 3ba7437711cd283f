// The instruction `excite`.
#include <gmock/gmock.h>

#include "mjarm/collision/exact.hpp"
#include "mjarm/program/load_program.hpp"
#include "mjarm/program/program_reader.hpp"
#include "mjarm/program/urscript.hpp"

namespace mjarm::program {
namespace {

using ::testing::HasSubstr;

TEST(Excite, ShippedProgramsMoveEveryJointFarWithoutContactAndComeBack) {
  for (const char* name : {"excite", "excite_panda"}) {
    const LoadedProgram loaded = load_sound_program(name).value();
    ASSERT_EQ(loaded.plan.moves.size(), 1u);
    const PlannedMove& move = loaded.plan.moves.front();
    EXPECT_EQ(move.word, "excite");
    EXPECT_DOUBLE_EQ(move.trajectory.duration(), 20);
    EXPECT_EQ(move.trajectory.at(20).q, loaded.plan.q_start);
    ExactChecker checker(loaded.robot.model, loaded.robot.arm);
    JointVec farthest = JointVec::Zero(loaded.robot.arm.dof());
    for (double t = 0; t < 20; t += 0.004) {
      const JointVec q = move.trajectory.at(t).q;
      EXPECT_TRUE(checker.is_free(as_span(q))) << name << " " << t;
      farthest = farthest.cwiseMax((q - loaded.plan.q_start).cwiseAbs());
    }
    EXPECT_GT(farthest.minCoeff(), 0.2) << name;
  }
}

std::string said_of(const std::string& words) {
  const auto program =
      parse_program("robot: ur5e\nprogram:\n  - excite: " + words + "\n", "p.yaml");
  return program ? std::string() : program.error().what;
}

TEST(Excite, ValuesThatAreNoneAreFaultsWithTheirLine) {
  EXPECT_EQ(said_of("10"), "");
  EXPECT_EQ(said_of("{seconds: 30, seed: 7}"), "");
  EXPECT_THAT(said_of("1"), HasSubstr("p.yaml:3:13: excite: an excitation takes 5 to 120 s"));
  EXPECT_THAT(said_of("{seconds: 500}"), HasSubstr("excite: seconds: an excitation takes"));
  EXPECT_THAT(said_of("{seed: 1.5}"), HasSubstr("excite: seed: expected a whole number"));
  EXPECT_THAT(said_of("{second: 20}"), HasSubstr("did you mean \"seconds\""));
}

TEST(Excite, IsNotExported) {
  const LoadedProgram loaded = load_sound_program("excite").value();
  const auto script = to_urscript(loaded.program, loaded.robot, loaded.plan, {});
  ASSERT_FALSE(script.has_value());
  EXPECT_THAT(script.error().what, HasSubstr("excite"));
}

}  // namespace
}  // namespace mjarm::program
