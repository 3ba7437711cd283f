// What the check of models says of grippers beside what it measures; planted faults are in tests/.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>
#include <string>
#include <vector>

#include "mjarm/core/os_cpu_time.hpp"
#include "mjarm/model/check.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/model/grip_diagnosis_internal.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Words = std::vector<std::string>;

/// The UR5e with its gripper, under options of the scene, and with `more` in it.
std::string scene_of(const std::string& option, const std::string& more = "") {
  return "<mujoco><include file=\"universal_robots_ur5e/ur5e_gripper.xml\"/>" + option + more +
         "</mujoco>";
}
constexpr const char* kSoftFriction = "<option cone=\"pyramidal\" impratio=\"1\"/>";

CheckReport report_on(const std::filesystem::path& file) {
  const auto report = check_model(file);
  if (!report) throw std::runtime_error(report.error().what);
  return *report;
}

/// `CODE: WHAT` of what is said about the gripper.
Words about_grip(const CheckReport& report) {
  Words words;
  for (const Finding& finding : report.findings) {
    if (finding.code < CheckCode::grip_creep || finding.code > CheckCode::grip_not_measured) {
      continue;
    }
    EXPECT_EQ(finding.grade, Grade::note);
    words.push_back(std::string(name(finding.code)) + ": " + finding.what);
  }
  return words;
}

detail::GripDiagnosis diagnosed(const std::filesystem::path& file) {
  const auto model = Model::load(file);
  if (!model) throw std::runtime_error(model.error().what);
  const auto arm = find_arm(*model);
  if (!arm) throw std::runtime_error(arm.error().what);
  const auto grip = detail::diagnose_grip(*model, *arm, {});
  if (!grip) throw std::runtime_error(grip.error().what);
  return *grip;
}

TEST(CheckGrip, OursHold) {
  for (const char* robot :
       {"universal_robots_ur5e/ur5e_gripper.xml", "universal_robots_ur5e/pick.xml",
        "franka_emika_panda/panda.xml", "franka_emika_panda/pick.xml"}) {
    SCOPED_TRACE(robot);
    const auto file = find_model_file(robot);
    ASSERT_TRUE(file) << file.error().what;
    const CheckReport report = report_on(*file);
    EXPECT_THAT(about_grip(report), IsEmpty());
    EXPECT_TRUE(report.grip_mend.empty());
    const detail::GripDiagnosis grip = diagnosed(*file);
    EXPECT_TRUE(grip.as_is.held);
    EXPECT_LT(grip.as_is.creep, 1.7e-6) << "0.1 mm a minute";
  }
}

/// What a file may have beside, which is none of the grip's business.
TEST(CheckGrip, OursHoldInAnyKindOfStep) {
  const support::TempFolder folder;
  for (const char* option :
       {"integrator=\"RK4\"", "integrator=\"Euler\"", "timestep=\"0.005\"", "timestep=\"0.0002\"",
        "gravity=\"0 0 0\"", "noslip_iterations=\"3\"", "solver=\"CG\""}) {
    const auto file = folder.write("a.xml", scene_of("<option " + std::string(option) + "/>"));
    EXPECT_THAT(about_grip(report_on(file)), IsEmpty()) << option;
    EXPECT_TRUE(diagnosed(file).as_is.held) << option;
  }
  // Forces that begin 1 mm before the surfaces meet.
  const auto ahead = folder.write(
      "b.xml", "<mujoco><default><geom margin=\"0.001\"/></default>" + scene_of("").substr(8));
  const Model model = Model::load(ahead).value();
  const int pad = mj_name2id(model.raw(), mjOBJ_GEOM, "left_pad_solid");
  ASSERT_EQ(model.raw()->geom_margin[pad], 0.001);
  EXPECT_TRUE(diagnosed(ahead).as_is.held);
}

TEST(CheckGrip, NothingIsSaidWithoutAGripper) {
  for (const char* robot : {"ur5e", "car", "hello", "franka_emika_panda/panda_nohand.xml"}) {
    const CheckReport report = report_on(find_model_file(robot).value());
    EXPECT_THAT(about_grip(report), IsEmpty()) << robot;
    EXPECT_TRUE(report.grip_mend.empty());
  }
}

/// [m/s] at which a cube slips along the tool's axis, the arm held by its servos at home, where the
/// gripper points down: MuJoCo alone.
double simulated_creep(const std::filesystem::path& file, int part_of_scene) {
  const Model model = Model::load(file).value();
  const Arm arm = find_arm(model).value();
  const mjModel* m = model.raw();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
  mj_resetDataKeyframe(m, d.get(), 0);
  const int site = mj_name2id(m, mjOBJ_SITE, arm.tip.c_str());
  mj_forward(m, d.get());
  mjtNum* const qpos = d->qpos + m->jnt_qposadr[m->body_jntadr[part_of_scene]];
  mju_copy3(qpos, d->site_xpos + 3 * site);
  mju_mat2Quat(qpos + 3, d->site_xmat + 9 * site);
  d->ctrl[arm.gripper->drives[0].id] = arm.gripper->drives[0].ctrl_closed;
  const auto run = [&](double seconds) {
    for (const double end = d->time + seconds; d->time < end;) {
      // Held by a hand until the fingers have it.
      if (d->time < 0.5) mju_zero3(d->qvel + m->body_dofadr[part_of_scene]);
      mj_step(m, d.get());
    }
    const Eigen::Vector3d way(Eigen::Vector3d(d->xpos + 3 * part_of_scene) -
                              Eigen::Vector3d(d->site_xpos + 3 * site));
    return -way.z();
  };
  const double before = run(2);
  return (run(1) - before) / 1;
}

TEST(CheckGrip, CreepIsThatOfASimulationOfTheWholeArm) {
  const support::TempFolder folder;
  const auto bare = folder.write("bare.xml", scene_of(kSoftFriction));
  const auto with_cube = folder.write(
      "cube.xml", scene_of(kSoftFriction,
                           "<worldbody><body name=\"cube\" pos=\"0 0 3\"><freejoint/><geom "
                           "type=\"box\" size=\".02125 .02125 .02125\" mass=\".1\"/></body>"
                           "</worldbody>"));
  const Model model = Model::load(with_cube).value();
  const int cube = mj_name2id(model.raw(), mjOBJ_BODY, "cube");
  const detail::GripDiagnosis grip = diagnosed(bare);
  EXPECT_NEAR(grip.edge, 0.0425, 1e-4);
  const double simulated = simulated_creep(with_cube, cube);
  EXPECT_GT(simulated, 5e-6);
  EXPECT_NEAR(grip.as_is.creep, simulated, 0.15 * simulated);
  EXPECT_LT(grip.mended.creep, 0.1 * grip.as_is.creep);
}

TEST(CheckGrip, TellsTheCreepAsItIsAndMended) {
  const support::TempFolder folder;
  const auto file = folder.write("a.xml", scene_of(kSoftFriction));
  const CheckReport report = report_on(file);
  const Words words = about_grip(report);
  ASSERT_THAT(words, SizeIs(3));
  EXPECT_THAT(words[0],
              HasSubstr("grip_creep: a cube of 42.5 mm and 0.1 kg held between the "
                        "fingers: 10 um/s of creep; with the settings of --fix: 0.17 um/s"));
  EXPECT_THAT(words[1], HasSubstr("grip_cone: "));
  EXPECT_THAT(words[2], HasSubstr("grip_impratio: impratio is 1"));
  EXPECT_EQ(about_grip(report_on(file)), words) << "the same a second time";
}

TEST(CheckGrip, WhatIsMendedIsNotFoundAgain) {
  const support::TempFolder folder, other;
  const auto file = folder.write("a.xml", scene_of(kSoftFriction));
  const CheckReport report = report_on(file);
  ASSERT_FALSE(report.grip_mend.empty());
  const auto exported = export_mended(Model::load(file).value(), report.grip_mend, other.path());
  ASSERT_TRUE(exported) << exported.error().what;
  EXPECT_THAT(exported->notes, IsEmpty());
  const auto mended = other.write("b.xml", exported->content);
  EXPECT_THAT(about_grip(report_on(mended)), IsEmpty());
  EXPECT_NEAR(diagnosed(mended).as_is.creep, diagnosed(file).mended.creep, 1e-9);

  const Model before = Model::load(file).value(), after = Model::load(mended).value();
  const mjModel &a = *before.raw(), &b = *after.raw();
  ASSERT_EQ(a.ngeom, b.ngeom);
  for (int g = 0; g < static_cast<int>(a.ngeom); ++g) {
    EXPECT_EQ(a.geom_solref[2 * g], b.geom_solref[2 * g]);
    EXPECT_EQ(a.geom_condim[g], b.geom_condim[g]);
  }
  EXPECT_EQ(b.opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(b.opt.timestep, a.opt.timestep);
}

TEST(CheckGrip, AnotherFileUnderTheSameNameIsNotMended) {
  const support::TempFolder folder;
  const auto file = folder.write("a.xml", scene_of(kSoftFriction));
  const CheckReport report = report_on(file);
  const Model model = Model::load(file).value();
  folder.write("a.xml", scene_of(kSoftFriction, "<worldbody><geom size=\"1\"/></worldbody>"));
  const auto exported = export_mended(model, report.grip_mend, folder.path());
  ASSERT_FALSE(exported);
  EXPECT_THAT(exported.error().what, HasSubstr("not the one any more"));
}

/// A wrist with a gripper whose fingers are plates with a hook at one edge, seen along z like an L.
std::string hooked_gripper(const std::string& finger) {
  const auto body = [&](const std::string& side, const std::string& place) {
    return "<body name=\"" + side + "\" " + place +
           "><inertial pos=\"0 0 0\" mass=\".1\" "
           "diaginertia=\"1e-4 1e-4 1e-4\"/><joint name=\"" +
           side +
           "\" type=\"slide\" axis=\"0 1 0\" range=\"0 .04\" damping=\"10\" armature=\"1\"/>" +
           finger + "</body>";
  };
  return R"(<mujoco><option cone="elliptic" impratio="30" integrator="implicitfast"/>
    <default><geom priority="1" condim="6" solref=".004 1" solimp=".99 .995 .001"/></default>
    <asset><mesh name="hook" vertex="-.015 .005 -.02  .05 .005 -.02  .05 -.04 -.02  .045 -.04 -.02
      .045 0 -.02  -.015 0 -.02  -.015 .005 .02  .05 .005 .02  .05 -.04 .02  .045 -.04 .02
      .045 0 .02  -.015 0 .02" face="0 1 4 0 4 5 1 2 3 1 3 4 6 10 7 6 11 10 7 9 8 7 10 9
      0 6 7 0 7 1 1 7 8 1 8 2 2 8 9 2 9 3 3 9 10 3 10 4 4 10 11 4 11 5 5 11 6 5 6 0"/></asset>
    <worldbody><body name="wrist" pos="0 0 1"><joint name="turn" axis="0 0 1" range="-2 2"/>
      <geom type="cylinder" size=".03 .02" pos="0 0 .1"/>
      <body name="hand" quat="0 1 0 0"><inertial pos="0 0 0" mass=".5" diaginertia="1e-3 1e-3 1e-3"/>
      <geom type="box" size=".05 .05 .005" pos="0 0 -.06"/><site name="tcp"/>)" +
         body("left", "") + body("right", "quat=\"0 0 0 1\"") + R"(</body></body></worldbody>
    <tendon><fixed name="grip"><joint joint="left" coef=".5"/><joint joint="right" coef=".5"/></fixed>
    </tendon><equality><joint joint1="left" joint2="right"/></equality>
    <actuator><position joint="turn" kp="100" kv="10"/><position name="grip" tendon="grip" kp="4000"
      kv="400" forcerange="-60 60" ctrlrange="0 .04"/></actuator>
    <keyframe><key name="home" qpos="0 .04 .04" ctrl="0 .04"/></keyframe></mujoco>)";
}

TEST(CheckGrip, HullsThatFillTheJawsAreTold) {
  const support::TempFolder folder;
  const auto whole =
      folder.write("whole.xml", hooked_gripper("<geom type=\"mesh\" mesh=\"hook\"/>"));
  const Words words = about_grip(report_on(whole));
  ASSERT_THAT(words, ::testing::Not(IsEmpty()));
  EXPECT_THAT(words[0], HasSubstr("jaws_overlap: reaches "));
  EXPECT_THAT(words[0], HasSubstr("mm into the space between the open fingers"));
  const auto pieces = folder.write(
      "pieces.xml",
      hooked_gripper("<geom type=\"box\" size=\".0325 .0025 .02\" pos=\".0175 .0025 0\"/>"
                     "<geom type=\"box\" size=\".0025 .02 .02\" pos=\".0475 -.02 0\"/>"));
  EXPECT_THAT(about_grip(report_on(pieces)), IsEmpty());
}

TEST(CheckGrip, ScenesTooLargeToTryAreToldSo) {
  const support::TempFolder folder;
  std::string balls = "<worldbody>";
  for (int i = 0; i < 20; ++i) {
    balls += "<body pos=\"3 " + std::to_string(i) + " 0\"><freejoint/><geom size=\".1\"/></body>";
  }
  const auto file = folder.write("a.xml", scene_of("", balls + "</worldbody>"));
  const double begin = cpu_seconds();
  const Words words = about_grip(report_on(file));
  EXPECT_LT(cpu_seconds() - begin, 2);
  ASSERT_THAT(words, SizeIs(1));
  EXPECT_THAT(words[0], HasSubstr("grip_not_measured: what the gripper holds is not measured: 128 "
                                  "degrees of freedom are too many"));
}

}  // namespace
}  // namespace mjarm
