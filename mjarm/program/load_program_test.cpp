#include "mjarm/program/load_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kThere = R"(robot: ur5e
program:
  - movej: {joints: [-1.3, -1.5708, 1.5708, -1.5708, -1.5708, 0]}
)";
/// Two moves that are out of reach, each by itself.
constexpr const char* kTooFar = R"(robot: ur5e
program:
  - movej: {pos: [3, 0, 0.4], euler: [180deg, 0, 0]}
  - wait: 100ms
  - movej: {pos: [0, 3, 0.4], euler: [180deg, 0, 0]}
)";

TEST(LoadProgram, APathIsReadItsRobotLoadedAndAllOfItPlanned) {
  const support::TempFolder folder;
  const auto file = folder.write("there.yaml", kThere);
  const Result<LoadedProgram> loaded = load_program(file.string());
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->file, file.string());
  EXPECT_EQ(loaded->program.name, "there");
  EXPECT_EQ(loaded->robot.arm.dof(), 6);
  EXPECT_TRUE(loaded->plan.ok());
  ASSERT_EQ(loaded->plan.moves.size(), 1U);
  EXPECT_EQ(loaded->plan.q_start, loaded->robot.arm.home);
  EXPECT_NEAR(loaded->plan.q_end()[0], -1.3, 1e-12);
}

TEST(LoadProgram, ShippedOnesAreKnownByName) {
  for (const char* name : {"ellipse", "ellipse.yaml"}) {
    const auto file = find_program_file(name);
    ASSERT_TRUE(file) << file.error().what;
    EXPECT_THAT(file->string(), EndsWith("programs/ellipse.yaml"));
    EXPECT_EQ(*file, find_shipped_program(name).value());
  }
  const auto unknown = load_program("elipse");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Errc::bad_input);
  EXPECT_THAT(unknown.error().what, HasSubstr("\"ellipse\""));
  // A file of the working directory is not a shipped program, whatever it is called.
  const support::TempFolder folder;
  EXPECT_FALSE(find_shipped_program(folder.write("mine.yaml", kThere).string()));
}

TEST(LoadProgram, TellsProgramsFromModels) {
  EXPECT_TRUE(is_program("whatever.yaml"));
  EXPECT_TRUE(is_program("whatever.yml"));
  EXPECT_TRUE(is_program("ellipse"));
  EXPECT_FALSE(is_program("ur5e"));
  EXPECT_FALSE(is_program("ellipsoid"));
}

TEST(LoadProgram, FaultsNameTheirPlaceAndHowManyMoreThereAre) {
  const support::TempFolder folder;
  const std::string file = folder.write("far.yaml", kTooFar).string();
  const Result<LoadedProgram> loaded = load_program(file);
  ASSERT_TRUE(loaded) << "a program that cannot be done is still read";
  ASSERT_EQ(loaded->plan.faults.size(), 2U);
  EXPECT_THAT(line_of(*loaded, loaded->plan.faults[1]), StartsWith(file + ":5:"));
  EXPECT_THAT(line_of(*loaded, loaded->plan.faults[1]), HasSubstr(": movej: "));
  const Result<LoadedProgram> sound = load_sound_program(file);
  ASSERT_FALSE(sound);
  EXPECT_EQ(sound.error().code, Errc::impossible);
  EXPECT_THAT(sound.error().what, StartsWith(file + ":3:"));
  EXPECT_THAT(sound.error().what, EndsWith(" (and 1 more)"));
  EXPECT_EQ(sound.error().what, first_fault(*loaded).what);
}

TEST(LoadProgram, AFaultOfNoFileHasNoPlace) {
  Program program;
  program.name = "made";
  program.instructions = {move_j(std::vector<double>{1, 2})};
  const support::TempFolder folder;
  Robot robot = std::move(load_program(folder.write("there.yaml", kThere).string())->robot);
  const auto loaded = plan_loaded("made.yaml", std::move(program), std::move(robot));
  ASSERT_TRUE(loaded);
  ASSERT_FALSE(loaded->plan.ok());
  EXPECT_THAT(first_fault(*loaded).what, StartsWith("made.yaml: movej: "));
}

}  // namespace
}  // namespace mjarm::program
