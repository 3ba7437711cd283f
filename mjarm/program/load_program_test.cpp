#include "mjarm/program/load_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mjarm/core/language_scope.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::program {
namespace {

using ::testing::AllOf;
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
    EXPECT_THAT(file->generic_string(), EndsWith("programs/ellipse.yaml"));
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

TEST(LoadProgram, WhatItNamesIsLookedForAndFaultsStandAtItsName) {
  const support::TempFolder folder;
  const auto error = [&](const std::string& head) {
    const std::string file =
        folder.write("cell.yaml", head + "program: [movej: {joints: home}]\n").string();
    const Result<LoadedProgram> loaded = load_program(file);
    if (loaded) return std::string("none");
    EXPECT_THAT(loaded.error().what, StartsWith(file + ":"));
    return loaded.error().what.substr(file.size());
  };
  EXPECT_THAT(error("robot: ur5f\n"), AllOf(StartsWith(":1:8: "), HasSubstr("\"ur5e\"")));
  EXPECT_THAT(error("robot: ur5e\nscene: no_such.xml\n"),
              AllOf(StartsWith(":2:8: "), HasSubstr("no_such.xml")));
  EXPECT_THAT(error("robot: ur5e\n\ntool: atachment_site\n"),
              AllOf(StartsWith(":3:7: "), HasSubstr("atachment_site")));
  EXPECT_THAT(error("robot: ur5e\nspeed: 0\n"), StartsWith(":2:8: "));
  // A file that is there and no model is the fault of the name, with what is wrong inside it.
  folder.write("broken.xml", "<mujoco><worldbody>");
  EXPECT_THAT(error("tool: x\nrobot: broken.xml\n"),
              AllOf(StartsWith(":2:8: "), HasSubstr("broken.xml")));
  // Nothing of it holds an arm.
  folder.write("still.xml", "<mujoco><worldbody><geom size='0.1'/></worldbody></mujoco>");
  EXPECT_THAT(error("robot: still.xml\n"), StartsWith(":1:8: "));
}

/// A program and what it names are moved together: paths begin at its folder, not where it is run.
TEST(LoadProgram, PathsStartFromTheFolderOfTheProgram) {
  const support::TempFolder folder;
  folder.write("arms/two.xml", R"(<mujoco><worldbody><body name="a" pos="0 0 1">
    <joint name="j1" axis="0 1 0" range="-2 2" limited="true"/><geom size="0.02 0.2" type="capsule" mass="1"/>
    <body name="b" pos="0.5 0 0"><joint name="j2" axis="0 1 0" range="-2 2" limited="true"/>
      <geom size="0.02 0.1" type="capsule" mass="1"/><site name="tip" pos="0.4 0 0"/></body>
    </body></worldbody><actuator><position joint="j1" kp="100"/><position joint="j2" kp="100"/></actuator></mujoco>)");
  const std::string text = "robot: ../arms/two.xml\ntool: tip\nprogram: [wait: 500ms]\n";
  const Result<LoadedProgram> loaded = load_program(folder.write("jobs/one.yml", text).string());
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_EQ(loaded->program.name, "one");
  EXPECT_EQ(loaded->robot.arm.dof(), 2);
  EXPECT_EQ(loaded->robot.arm.tip, "tip");
  EXPECT_EQ(loaded->plan.duration(), 0.5);
  // The same text elsewhere finds nothing.
  EXPECT_FALSE(load_program(folder.write("one.yml", text).string()));
}

/// A scene of one's own stands beside the program; what it includes may be shipped.
TEST(LoadProgram, MayNameASceneOfItsOwn) {
  const support::TempFolder folder;
  folder.write("cell.xml", R"(<mujoco model="cell">
  <include file="../universal_robots_ur5e/ur5e.xml"/>
  <include file="../scenes/studio.xml"/>
  <worldbody><geom name="post" type="box" size="0.05 0.05 0.2" pos="0.6 0 0.2"/></worldbody>
</mujoco>)");
  const std::string rest = "\nprogram: [movej: {joints: [-1.3, -1.57, 1.57, -1.57, -1.57, 0]}]\n";
  for (const char* head : {"scene: cell.xml", "robot: ur5e\nscene: ../cell.xml",
                           "scene: universal_robots_ur5e/wall.xml"}) {
    const bool below = std::string(head).find("..") != std::string::npos;
    const auto file = folder.write(below ? "jobs/one.yaml" : "one.yaml", head + rest);
    const Result<LoadedProgram> loaded = load_sound_program(file.string());
    ASSERT_TRUE(loaded) << head << ": " << loaded.error().what;
    EXPECT_EQ(loaded->robot.arm.dof(), 6);
  }
}

TEST(LoadProgram, FilesOutsideOfTheScenesFolderAreReadWhereThatIsAllowed) {
  const support::TempFolder folder;
  folder.write("part.xml", "<mujocoinclude><option timestep='0.003'/></mujocoinclude>");
  folder.write("in/cell.xml",
               "<mujoco><include file='universal_robots_ur5e/ur5e.xml'/>\n"
               "<include file='../part.xml'/></mujoco>");
  const std::string file =
      folder.write("in/one.yaml", "scene: cell.xml\nprogram: [wait: 1]\n").string();
  const Result<LoadedProgram> refused = load_sound_program(file);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, StartsWith(file + ":1:8: "));
  EXPECT_THAT(refused.error().what, HasSubstr("--allow-outside"));
  const Result<LoadedProgram> loaded = load_sound_program(file, {}, {.allow_outside = true});
  ASSERT_TRUE(loaded) << loaded.error().what;
  EXPECT_DOUBLE_EQ(loaded->robot.model.timestep(), 0.003);
}

TEST(LoadProgram, EveryShippedProgramIsFoundByItsNameAndSound) {
  for (const char* name : {"movej", "point", "movel"}) {
    const Result<LoadedProgram> loaded = load_sound_program(name);
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded->program.name, name);
    EXPECT_GT(loaded->plan.duration(), 0) << name;
    EXPECT_EQ(loaded->control(), loaded->program.control.value_or(ControlMode::computed_torque));
  }
  EXPECT_FALSE(find_shipped_program(""));
  EXPECT_FALSE(find_shipped_program("ellipse.yml"));
  EXPECT_FALSE(find_shipped_program("../programs/ellipse"));
}

TEST(LoadProgram, FaultsAreCountedInChineseToo) {
  const LanguageScope chinese(Language::chinese);
  const support::TempFolder folder;
  const Result<LoadedProgram> sound =
      load_sound_program(folder.write("far.yaml", kTooFar).string());
  ASSERT_FALSE(sound);
  EXPECT_THAT(sound.error().what, EndsWith("（另有 1 处）"));
  EXPECT_THAT(sound.error().what, HasSubstr("far.yaml:3:5：movej："));
}

}  // namespace
}  // namespace mjarm::program
