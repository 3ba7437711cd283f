// What overlaps by design: found by drawing postures, and nothing else is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/model/check.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// An arm of three links: "one" and "three" are two joints apart and reach into each other where
/// "two" between them is short. "three" is long enough to meet the foot in some postures.
struct Chain {
  double middle = 0.03;    ///< [m] length of "two"
  double foot_gap = 0.05;  ///< [m] between the foot and "one"
  std::string in_hand = {};
  std::string in_world = {};
  std::string options = {};

  [[nodiscard]] std::string xml() const {
    const std::string gap = std::to_string(foot_gap), far = std::to_string(middle);
    return R"(<mujoco model="chain"><compiler angle="radian" autolimits="true"/><option>)" +
           options + R"(</option><worldbody>
      <geom name="pillar" type="cylinder" size="0.05 0.1" pos="0 0 -0.1"/>)" +
           in_world + R"(
      <body name="one" pos="0 0 )" +
           gap + R"("><joint name="j1" axis="0 0 1"/>
        <geom type="capsule" fromto="0 0 0.04 0 0 0.2" size="0.04"/>
        <body name="two" pos="0 0 0.2"><joint name="j2" axis="0 1 0" range="-2 2"/>
          <geom type="sphere" size="0.02"/>
          <body name="three" pos="0 0 )" +
           far + R"("><joint name="j3" axis="1 0 0" range="-2.5 2.5"/>
            <geom name="arm3" type="capsule" fromto="0 0 0.01 0 0 0.4" size="0.03"/>
            <site name="tcp" pos="0 0 0.45"/>)" +
           in_hand + R"(
          </body></body></body></worldbody>
      <actuator><position joint="j1"/><position joint="j2"/><position joint="j3"/></actuator>
    </mujoco>)";
  }
};

Result<Arm> arm_of(const std::string& xml) {
  const support::TempFolder folder;
  return load_robot(folder.write("chain.xml", xml).string(), {.tip = "tcp"}).map([](Robot&& robot) {
    return std::move(robot.arm);
  });
}

/// `LINK - OTHER` of each pair.
std::vector<std::string> pairs_of(const std::string& xml) {
  const Result<Arm> arm = arm_of(xml);
  EXPECT_TRUE(arm) << (arm ? "" : arm.error().what);
  std::vector<std::string> out;
  for (const DesignOverlap& pair : arm.value_or(Arm{}).overlapping) {
    out.push_back(pair.names[0] + " - " + pair.names[1]);
  }
  return out;
}

TEST(DesignOverlaps, AreThoseOfEveryPosture) {
  EXPECT_THAT(pairs_of(Chain{}.xml()), ElementsAre("one - three"));
  EXPECT_THAT(pairs_of(Chain{.foot_gap = -0.01}.xml()), ElementsAre("one - three", "one - pillar"));
  // Far enough apart to meet when the arm is folded only.
  EXPECT_THAT(pairs_of(Chain{.middle = 0.12}.xml()), IsEmpty());
}

/// Flush to rounding: a foot and the plate that turns on it, as links of other people's files are.
TEST(DesignOverlaps, WhatTouchesInEveryPostureIsOneOfThem) {
  const auto with_plate = [](const std::string& gap) {
    Chain chain{.middle = 0.12};
    std::string xml = chain.xml();
    const std::string plate =
        "<geom name=\"plate\" type=\"cylinder\" size=\"0.04 0.01\" pos=\"0 0 " + gap + "\"/>";
    const std::string joint = "<joint name=\"j1\" axis=\"0 0 1\"/>";
    return xml.replace(xml.find(joint), joint.size(), joint + plate);
  };
  EXPECT_THAT(pairs_of(with_plate("-0.039999999")), ElementsAre("one - pillar"));
  EXPECT_THAT(pairs_of(with_plate("-0.0395")), IsEmpty());
}

TEST(DesignOverlaps, AreFoundWhereTheFileSwitchesContactsOff) {
  EXPECT_THAT(pairs_of(Chain{.options = R"(<flag contact="disable"/>)"}.xml()),
              ElementsAre("one - three"));
}

TEST(DesignOverlaps, AreNoneWhereTheFileSaysThatTheyDoNotCollide) {
  std::string xml = Chain{}.xml();
  xml.insert(xml.find("<actuator>"), R"(<contact><exclude body1="one" body2="three"/></contact>)");
  EXPECT_THAT(pairs_of(xml), IsEmpty());
}

TEST(DesignOverlaps, WhatLiesOrIsHeldIsNoPartOfADesign) {
  // A cup round the tool, far inside "three" and moved by nothing, and one that a user moves.
  const std::string geom = R"(<geom type="sphere" size="0.5"/></body>)";
  for (const char* moved : {R"(<body name="cup" pos="0 0 0.4"><freejoint/>)",
                            R"(<body name="cup" pos="0 0 0.4" mocap="true">)",
                            R"(<body name="cup" pos="0 0 0.4"><joint type="ball"/>)"}) {
    EXPECT_THAT(pairs_of(Chain{.in_world = moved + geom}.xml()), ElementsAre("one - three"))
        << moved;
  }
  // The same thing, but standing, is met in every posture.
  const std::string stands =
      R"(<body name="cup" pos="0 0 0.4"><geom name="cup" type="sphere" size="0.5"/></body>)";
  EXPECT_THAT(pairs_of(Chain{.in_world = stands}.xml()),
              ElementsAre("one - three", "one - cup", "two - cup", "three - cup"));
}

TEST(DesignOverlaps, OfAFreeBaseAreThoseOfTheArm) {
  std::string xml = Chain{.foot_gap = -0.01}.xml();
  xml.replace(xml.find(R"(<body name="one")"), 0,
              R"(<body name="car" pos="0 0 1"><freejoint/><geom type="box" size="0.2 0.2 0.02"/>)");
  xml.replace(xml.find("</worldbody>"), 0, "</body>");
  EXPECT_THAT(pairs_of(xml), ElementsAre("one - three"));
}

TEST(DesignOverlaps, OfALinkAndTheWorldAreOfOneGeomOfIt) {
  const Result<Arm> arm =
      arm_of(Chain{.foot_gap = -0.01,
                   .in_world = R"(<geom name="wall" type="box" size="0.01 1 1" pos="0.3 0 0"/>)"}
                 .xml());
  ASSERT_TRUE(arm) << arm.error().what;
  EXPECT_TRUE(arm->overlap_by_design({.geom = 2, .body = 1}, {.geom = 0, .body = 0}));
  EXPECT_TRUE(arm->overlap_by_design({.geom = 0, .body = 0}, {.geom = 2, .body = 1}));
  EXPECT_FALSE(arm->overlap_by_design({.geom = 2, .body = 1}, {.geom = 1, .body = 0}));
  EXPECT_TRUE(arm->overlap_by_design({.geom = 2, .body = 1}, {.geom = 4, .body = 3}));
  EXPECT_FALSE(arm->overlap_by_design({.geom = 2, .body = 1}, {.geom = 3, .body = 2}));
}

TEST(DesignOverlaps, ACapsuleSunkInATableIsFound) {
  for (const char* table :
       {R"(<geom name="table" type="box" size="0.4 0.3 0.05" pos="0 0 -0.03"/>)",
        R"(<geom name="table" type="box" size="0.4 0.3 0.05" pos="0.1 0.1 -0.03"
                               euler="0.05 0.1 0.4"/>)"}) {
    std::string xml = Chain{.foot_gap = -0.01, .in_world = table}.xml();
    EXPECT_THAT(pairs_of(xml), ElementsAre("one - three", "one - pillar", "one - table")) << table;
  }
}

TEST(DesignOverlaps, ShippedArmsHaveNone) {
  for (const char* name : {"ur5e", "panda", "universal_robots_ur5e/ur5e.urdf",
                           "universal_robots_ur5e/wall.xml", "franka_emika_panda/panda.urdf"}) {
    EXPECT_TRUE(testing::shipped_arm(name).arm.overlapping.empty()) << name;
  }
}

TEST(DesignOverlaps, AreToldOnceByTheCheckOfAModel) {
  const support::TempFolder folder;
  const LanguageScope english(Language::english);
  const auto file = folder.write("chain.xml", Chain{.foot_gap = -0.01}.xml());
  const Result<CheckReport> report = check_model(file, {.tip = "tcp"});
  ASSERT_TRUE(report);
  std::vector<std::string> told;
  for (const Finding& finding : report->findings) {
    EXPECT_NE(finding.code, CheckCode::home_self_contact) << finding.what;
    EXPECT_NE(finding.code, CheckCode::home_contact) << finding.what;
    if (finding.code != CheckCode::overlap_by_design) continue;
    EXPECT_EQ(finding.grade, Grade::warning);
    EXPECT_GT(finding.line, 0);
    told.push_back(finding.element + " " + finding.what);
  }
  EXPECT_THAT(
      told,
      ElementsAre(HasSubstr(R"(<body "one"> overlaps or touches "three" in every posture)"),
                  HasSubstr(R"(<body "one"> overlaps or touches "pillar" in every posture)")));
}

}  // namespace
}  // namespace mjarm
