// Findings of the check of models that the planted faults do not reach, and what holds of all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/model/check.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;

CheckReport report_of(const std::string& name, const std::string& text) {
  const support::TempFolder folder;
  const Result<CheckReport> report = check_model(folder.write(name, text));
  EXPECT_TRUE(report) << (report ? "" : report.error().what);
  return *report;
}

/// `GRADE LINE WHAT` of every finding with this code.
std::vector<std::string> said(const CheckReport& report, CheckCode code) {
  std::vector<std::string> lines;
  for (const Finding& finding : report.findings) {
    if (finding.code != code) continue;
    lines.push_back(std::string(name(finding.grade)) + " " + std::to_string(finding.line) + " " +
                    finding.element + " " + finding.what);
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(CheckFindings, ALinkThatWeighsNextToNothingIsDoubted) {
  const CheckReport report = report_of("a.xml", R"(<mujoco><worldbody>
  <body name="a"><joint name="j"/>
    <inertial pos="0 0 0" mass="1e-5" diaginertia="1e-9 1e-9 1e-9"/>
  </body></worldbody></mujoco>)");
  const Lines lines = said(report, CheckCode::mass_implausible);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_THAT(lines[0], HasSubstr("warning 3 "));
  EXPECT_THAT(lines[0], HasSubstr("a joint moves only 1e-05 kg here"));
}

TEST(CheckFindings, AnArmWithoutShapesTouchesNothing) {
  const std::string bare = R"(<mujoco><worldbody><body name="a"><joint name="j"/>
    <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>%</body></worldbody></mujoco>)";
  const auto with = [&bare](const std::string& shape) {
    std::string text = bare;
    return said(report_of("a.xml", text.replace(text.find('%'), 1, shape)),
                CheckCode::collision_missing);
  };
  ASSERT_EQ(with("").size(), 1U);
  EXPECT_THAT(with("")[0], HasSubstr("the arm has no shapes: collisions will not be seen"));
  const std::string look = "<geom size=\".2\" contype=\"0\" conaffinity=\"0\"/>";
  ASSERT_EQ(with(look).size(), 1U);
  EXPECT_THAT(with(look)[0], HasSubstr("no shape of the arm touches anything"));
  EXPECT_TRUE(with("<geom size=\".2\"/>").empty());
}

TEST(CheckFindings, TheWorldIsThatOfTheEarthInSmallSteps) {
  const auto world = [](const std::string& option) {
    return report_of("a.xml", "<mujoco>\n" + option + "\n<worldbody/></mujoco>");
  };
  EXPECT_EQ(said(world("<option gravity=\"0 0 9.81\"/>"), CheckCode::gravity_odd),
            Lines{"warning 2 <option> gravity is (0, 0, 9.81) m/s^2; on earth (0, 0, -9.81)"});
  EXPECT_EQ(said(world("<option gravity=\"0 0 0\"/>"), CheckCode::gravity_odd),
            Lines{"note 2 <option> there is no gravity"});
  EXPECT_EQ(said(world("<option><flag gravity=\"disable\"/></option>"), CheckCode::gravity_odd),
            Lines{"note 2 <option> there is no gravity"});
  EXPECT_TRUE(said(world("<option gravity=\"0 0 -9.806\"/>"), CheckCode::gravity_odd).empty());
  EXPECT_EQ(said(world("<option timestep=\"0.02\"/>"), CheckCode::timestep_large),
            Lines{"warning 2 <option> a time step of 20 ms is too coarse for an arm: 1 to 5 ms are "
                  "usual"});
  EXPECT_TRUE(said(world("<option timestep=\"0.01\"/>"), CheckCode::timestep_large).empty());
}

TEST(CheckFindings, ServosAreAskedWhetherTheyPullTheRightWay) {
  const auto servo = [](const std::string& actuator) {
    return report_of("a.xml", R"(<mujoco><compiler angle="radian"/><worldbody><body name="a">
      <joint name="j" axis="0 1 0" range="-1 1"/><geom size=".1"/><site name="tool0"/>
      </body></worldbody><actuator>)" +
                                  actuator + "</actuator></mujoco>");
  };
  const CheckReport wrong = servo(
      "<general name=\"s\" joint=\"j\" biastype=\"affine\" gainprm=\"100\" biasprm=\"0 100 -10\" "
      "ctrlrange=\"-1 1\"/>");
  ASSERT_EQ(said(wrong, CheckCode::servo_unstable).size(), 1U);
  EXPECT_THAT(said(wrong, CheckCode::servo_unstable)[0],
              HasSubstr("pushes away from its command (stiffness -100 N m/rad)"));
  EXPECT_TRUE(said(wrong, CheckCode::servo_sag).empty());
  const std::string sound =
      "<position name=\"s\" joint=\"j\" kp=\"100\" kv=\"10\" "
      "ctrlrange=\"-1 1\" forcerange=\"-50 50\"";
  const CheckReport right = servo(sound + "/>");
  for (const CheckCode code : {CheckCode::servo_unstable, CheckCode::servo_undamped,
                               CheckCode::ctrl_range_differs, CheckCode::force_limit_missing}) {
    EXPECT_TRUE(said(right, code).empty()) << name(code);
  }
  EXPECT_EQ(said(servo(sound + "/>" + sound + "/>"), CheckCode::not_loadable).size(), 1U);
  const CheckReport twice = servo(sound + "/><motor joint=\"j\"/>");
  ASSERT_EQ(said(twice, CheckCode::actuator_doubled).size(), 1U);
  EXPECT_THAT(said(twice, CheckCode::actuator_doubled)[0], HasSubstr("2 actuators drive this"));
}

/// As wide as the joint's range, but beside it.
TEST(CheckFindings, CommandsThatMissHalfOfTheJointAreTold) {
  const CheckReport report = report_of("a.xml", R"(<mujoco><compiler angle="radian"/>
    <worldbody><body name="a"><joint name="j" axis="0 1 0" range="0 3"/><geom size=".1"/>
    <site name="tool0"/></body></worldbody><actuator>
<position name="s" joint="j" kp="100" kv="10" ctrlrange="-1 1"/></actuator></mujoco>)");
  EXPECT_EQ(said(report, CheckCode::ctrl_range_differs),
            Lines{"warning 4 <position \"s\"> commands reach from -1 to 1, the joint from 0 to 3"});
}

TEST(CheckFindings, ABaseThatNothingHoldsIsTold) {
  const auto with = [](const std::string& joint) {
    return said(report_of("a.xml", R"(<mujoco><compiler angle="radian"/><worldbody>
      <body name="base">)" + joint + R"(<geom size=".1"/>
        <body name="a"><joint name="j" axis="0 1 0" range="-1 1"/><geom size=".1"/>
        <site name="tool0"/></body></body></worldbody></mujoco>)"),
                CheckCode::base_floats);
  };
  EXPECT_TRUE(with("").empty());
  ASSERT_EQ(with("<freejoint/>").size(), 1U);
  EXPECT_THAT(with("<freejoint/>")[0], HasSubstr("warning 2 <body \"base\"> the arm stands on"));
}

TEST(CheckFindings, TheLanguageChangesTheWordsAndNothingElse) {
  for (const char* robot : {"ur5e", "panda", "car", "universal_robots_ur5e/ur5e.urdf"}) {
    const auto file = find_model_file(robot);
    ASSERT_TRUE(file) << file.error().what;
    const CheckReport english = check_model(*file).value();
    const LanguageScope scope(Language::chinese);
    const CheckReport chinese = check_model(*file).value();
    ASSERT_EQ(english.findings.size(), chinese.findings.size()) << robot;
    for (std::size_t i = 0; i < english.findings.size(); ++i) {
      const Finding &a = english.findings[i], &b = chinese.findings[i];
      EXPECT_EQ(a.code, b.code);
      EXPECT_EQ(a.grade, b.grade);
      EXPECT_EQ(a.file, b.file);
      EXPECT_EQ(a.line, b.line);
      EXPECT_NE(a.what, b.what);
      EXPECT_EQ(a.what.find('\n'), std::string::npos);
      EXPECT_EQ(a.line > 0 && a.file.empty(), false);
    }
    EXPECT_EQ(english.count(Grade::error), 0) << robot;
    EXPECT_EQ(
        english.count(Grade::error) + english.count(Grade::warning) + english.count(Grade::note),
        static_cast<int>(english.findings.size()));
  }
}

TEST(CtrlRange, OfAServoBehindATurnedGearIsSound) {
  const support::TempFolder folder;
  const auto report = check_model(folder.write("a.xml", R"(<mujoco>
      <compiler angle="radian"/>
      <worldbody><body name="a"><joint name="j" axis="0 1 0" range="-1 1"/><geom size=".1"/>
        <site name="tool0"/></body></worldbody>
      <actuator><position name="s" joint="j" gear="-1" kp="100" kv="10" ctrlrange="-1 1"
        forcerange="-50 50"/></actuator></mujoco>)"));
  ASSERT_TRUE(report);
  for (const Finding& finding : report->findings) {
    EXPECT_NE(finding.code, CheckCode::ctrl_range_differs) << finding.what;
  }
}

/// A servo of a joint from 0 to 2 rad, nearly without gravity: what is said of these commands.
CheckReport ranges(const std::string& ctrlrange) {
  return report_of("a.xml", R"(<mujoco><compiler angle="radian"/><option gravity="0 0 -1e-6"/>
      <worldbody><body name="a"><joint name="j" axis="0 1 0" range="0 2"/>
      <geom size=".1" pos=".1 0 0"/><site name="tool0"/></body></worldbody>
      <actuator><position name="s" joint="j" kp="100" kv="10" forcerange="-50 50" ctrlrange=")" +
                                ctrlrange + R"("/></actuator></mujoco>)");
}

TEST(CtrlRange, IsHeldAgainstWhereTheJointMoves) {
  for (const char* sound : {"0 2", "-0.2 2.1", "0.2 1.5", "-0.7 2.7"}) {
    EXPECT_TRUE(said(ranges(sound), CheckCode::ctrl_range_differs).empty()) << sound;
  }
  // As wide as the joint's, but elsewhere; twice as wide; degrees.
  for (const char* wrong : {"-1.2 0.8", "1.5 3.5", "-2 2", "0 115", "0 0.8"}) {
    EXPECT_EQ(said(ranges(wrong), CheckCode::ctrl_range_differs).size(), 1U) << wrong;
  }
}

TEST(CheckSag, IsNotToldWhereItIsNothing) {
  EXPECT_TRUE(said(ranges("0 2"), CheckCode::servo_sag).empty());
}

#if defined(__linux__)
TEST(NotLoadable, NamesTheLineAlsoInAFolderThatLooksLikeOne) {
  const support::TempFolder folder;
  const auto file = folder.write(
      "x:3:y/m.xml",
      "<mujoco><worldbody>\n<body name=\"a\"/>\n\n<geom sise=\"1\"/></worldbody></mujoco>");
  const auto report = check_model(file);
  ASSERT_TRUE(report);
  ASSERT_EQ(report->findings.size(), 1U);
  EXPECT_EQ(report->findings[0].file, file.string());
  EXPECT_EQ(report->findings[0].line, 4);
}
#endif

}  // namespace
}  // namespace mjarm
