// Faults of grippers, each of which is measured: what is held creeps, or the fingers are slow.
#include "tests/planted_faults.hpp"

namespace mjarm::planted {
namespace {

constexpr const char* kGripRobot = "universal_robots_ur5e/ur5e_gripper.xml";
constexpr const char* kGripClasses = "universal_robots_ur5e/parts/gripper_common.xml";
constexpr const char* kGripFingers = "universal_robots_ur5e/parts/gripper.xml";
constexpr const char* kGripDrive = "universal_robots_ur5e/parts/gripper_drive.xml";
constexpr const char* kGripOption = R"(cone="elliptic" impratio="30")";

/// The joints of both fingers with one more attribute; the left one, which is told, last.
std::vector<Edit> with_joints(const std::string& attribute) {
  std::vector<Edit> out;
  for (const char* side : {"right", "left"}) {
    const std::string joint =
        std::string("<joint name=\"") + side + "_finger_joint\" class=\"finger\"";
    out.push_back({"", joint + "/>", joint + " " + attribute + "/>"});
  }
  return out;
}

class PlantedGrip : public ::testing::TestWithParam<Fault> {};

TEST_P(PlantedGrip, IsNamed) { expect_named(GetParam()); }

bool is_about_grip(const Finding& finding) {
  return finding.code >= CheckCode::grip_creep && finding.code <= CheckCode::grip_not_measured;
}

TEST_P(PlantedGrip, IsNotFoundOnceMended) {
  const support::TempFolder folder, other;
  std::string text;
  ASSERT_NE(plant(folder, GetParam(), text), std::string::npos);
  CheckOptions options;
  options.load.allow_outside = true;
  const fs::path file = folder.path() / GetParam().main;
  const auto report = check_model(file, options);
  ASSERT_TRUE(report) << report.error().what;
  const bool hopeless = GetParam().code == CheckCode::grip_not_measured;
  ASSERT_EQ(report->grip_mend.empty(), hopeless) << all_of(*report);
  if (hopeless) return;
  const auto model = Model::load(file, options.load);
  ASSERT_TRUE(model) << model.error().what;
  const auto exported = export_mended(*model, report->grip_mend, other.path());
  ASSERT_TRUE(exported) << exported.error().what;
  const auto again = check_model(other.write("mended.xml", exported->content), options);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_TRUE(std::ranges::none_of(again->findings, is_about_grip)) << all_of(*again);
  EXPECT_TRUE(again->grip_mend.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Grippers, PlantedGrip,
    ::testing::Values(
        Fault{"Pyramidal",
              kGripRobot,
              kGripClasses,
              {{"", kGripOption, R"(cone="pyramidal" impratio="1")"}},
              CheckCode::grip_cone,
              kNote,
              "<option>"},
        Fault{"LowImpratio",
              kGripRobot,
              kGripClasses,
              {{"", kGripOption, R"(cone="elliptic" impratio="1")"}},
              CheckCode::grip_impratio,
              kNote,
              "<option>"},
        Fault{"SoftPads",
              kGripRobot,
              kGripClasses,
              {{"", R"(solref="0.0005 1" solimp="0.998 0.999 0.001")",
                R"(solref="0.02 1" solimp="0.9 0.95 0.001")"}},
              CheckCode::pads_soft,
              kNote,
              R"(<geom "left_pad_solid">)"},
        Fault{"SlipperyPads",
              kGripRobot,
              kGripClasses,
              {{"", R"(friction="1 0.02)", R"(friction="0.2 0.02)"}},
              CheckCode::pads_slippery,
              kNote,
              R"(<geom "left_pad_solid">)"},
        Fault{"IcyPads",
              kGripRobot,
              kGripClasses,
              {{"", R"(friction="1 0.02)", R"(friction="0.005 0.02)"}},
              CheckCode::pads_slippery,
              kNote,
              R"(<geom "left_pad_solid">)"},
        Fault{"PadsThatLetTwist",
              kGripRobot,
              kGripClasses,
              {{"", R"(condim="6")", R"(condim="3")"}},
              CheckCode::pads_condim,
              kNote,
              R"(<geom "left_pad_solid">)"},
        Fault{"PadsWithoutFriction",
              kGripRobot,
              kGripClasses,
              {{"", R"(condim="6")", R"(condim="1")"}},
              CheckCode::pads_condim,
              kNote,
              R"(<geom "left_pad_solid">)"},
        Fault{"DampedBesideInertia", kGripRobot, kGripFingers, with_joints(R"(damping="2000")"),
              CheckCode::finger_damping, kNote, R"(<joint "left_finger_joint">)"},
        Fault{"DriveBesideInertia", kGripRobot, kGripFingers, with_joints(R"(armature="0")"),
              CheckCode::finger_damping, kNote, R"(<joint "left_finger_joint">)"},
        Fault{"SlowByDamping", kGripRobot, kGripFingers, with_joints(R"(damping="8000")"),
              CheckCode::finger_slow, kNote, R"(<joint "left_finger_joint">)"},
        Fault{"SlowByArmature", kGripRobot, kGripFingers, with_joints(R"(armature="1000")"),
              CheckCode::finger_slow, kNote, R"(<joint "left_finger_joint">)"},
        Fault{
            "FingersThatOverlap",
            kGripRobot,
            kGripFingers,
            {{"", R"(<geom name="left_finger_solid")",
              R"(<geom name="spur" class="solid" type="box" pos="0 -0.06 0.01" size="0.012 0.035 0.01"/>
    <geom name="left_finger_solid")"}},
            CheckCode::jaws_overlap,
            kNote,
            R"(<geom "spur">)"},
        Fault{
            "FingersThatMeetBeforeTheCube",
            kGripRobot,
            kGripFingers,
            {{"", R"(<geom name="left_finger_solid")",
              R"(<geom name="spur" class="solid" type="box" pos="0 -0.03 0.01" size="0.012 0.035 0.01"/>
    <geom name="left_finger_solid")"}},
            CheckCode::jaws_overlap,
            kNote,
            R"(<geom "spur">)"},
        Fault{"Creep",
              kGripRobot,
              kGripDrive,
              {{"", "<contact>", R"(<option cone="pyramidal" impratio="1"/>
  <contact>)"}},
              CheckCode::grip_creep,
              kNote,
              R"(<general "gripper">)",
              R"(<general name="gripper")"},
        Fault{"TooWeak",
              kGripRobot,
              kGripDrive,
              {{"", R"(forcerange="-120 120")", R"(forcerange="-0.8 0.8")"}},
              CheckCode::grip_not_measured,
              kNote,
              R"(<general "gripper">)"}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace mjarm::planted
