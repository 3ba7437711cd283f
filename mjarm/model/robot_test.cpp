#include "mjarm/model/robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "mjarm/core/rng.hpp"
#include "mjarm/model/shipped_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Two hinges, a site and a body of the same name, a free ball beside.
constexpr const char* kTwoHinges = R"(<mujoco model="two"><compiler angle="radian"/><worldbody>
  <body name="a" pos="0 0 1"><joint name="ja" axis="0 1 0" range="-1 3"/><geom size=".05"/>
    <body name="b" pos="1 0 0"><joint name="jb" axis="0 1 0" pos="0.1 0 0"/><geom size=".05"/>
      <body name="tool0" pos="0.5 0 0"/><site name="tool0" pos="0 0 0.7"/>
      <body pos="0 0.2 0"><geom size=".01"/></body>
    </body></body>
  <body name="ball" pos="5 0 0"><freejoint/><geom size=".1"/></body>
</worldbody></mujoco>)";

/// The compiled model as MuJoCo writes it.
std::string bytes_of(const Model& model) {
  std::string bytes(static_cast<std::size_t>(mj_sizeModel(model.raw())), '\0');
  mj_saveModel(model.raw(), nullptr, bytes.data(), static_cast<mjtSize>(bytes.size()));
  return bytes;
}

TEST(LoadRobot, IsTheThreeStepsInOne) {
  const Result<Robot> robot = load_robot("panda");
  ASSERT_TRUE(robot) << robot.error().what;
  const testing::TestArm steps = testing::shipped_arm("panda");
  EXPECT_EQ(bytes_of(robot->model), bytes_of(steps.model));
  EXPECT_EQ(robot->arm.tip, steps.arm.tip);
  EXPECT_EQ(robot->arm.home, steps.arm.home);
  const Result<Robot> other = load_robot("panda", {.tip = "panda_link8"});
  ASSERT_TRUE(other) << other.error().what;
  EXPECT_EQ(other->arm.tip, "panda_link8");
}

TEST(LoadRobot, FailsWithTheErrorOfTheStepThatFailed) {
  const support::TempFolder folder;
  const fs::path good = folder.write("good.xml", kTwoHinges), bad = folder.write("bad.xml", "<mu");
  const fs::path still = folder.write("still.xml", "<mujoco><worldbody/></mujoco>");
  const auto what = [](const auto& result) { return result ? "" : result.error().what; };
  EXPECT_EQ(what(load_robot("no_robot")), what(find_model_file("no_robot")));
  EXPECT_EQ(what(load_robot(bad.string())), what(Model::load(bad)));
  EXPECT_EQ(what(load_robot(still.string())), what(find_arm(Model::load(still).value())));
  for (const auto& [tip, code, words] :
       {std::tuple("tool1", Errc::usage,
                   "good.xml: there is no site or body \"tool1\" (did you mean \"tool0\"?)"),
        std::tuple("gripper_center", Errc::usage,
                   "good.xml: there is no site or body \"gripper_center\""),
        std::tuple("world", Errc::usage, "good.xml: no joint moves \"world\""),
        std::tuple("ball", Errc::usage, "good.xml: no joint moves \"ball\""),
        std::tuple("#99", Errc::usage, "good.xml: there is no site or body \"#99\"")}) {
    const Result<Robot> robot = load_robot(good.string(), {.tip = tip});
    ASSERT_FALSE(robot) << tip;
    EXPECT_EQ(robot.error().code, code) << tip;
    EXPECT_THAT(robot.error().what, HasSubstr(words));
  }
}

TEST(LoadRobot, HandsOnHowTheFileIsRead) {
  const support::TempFolder folder;
  folder.write("part.xml", "<mujocoinclude><option timestep=\"0.003\"/></mujocoinclude>");
  const std::string file =
      folder
          .write("in/arm.xml", std::string(kTwoHinges)
                                   .insert(std::string(kTwoHinges).find("<comp"),
                                           "<include file=\"../part.xml\"/>"))
          .string();
  const Result<Robot> refused = load_robot(file);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("--allow-outside"));
  const Result<Robot> robot = load_robot(file, {.load = {.allow_outside = true}});
  ASSERT_TRUE(robot) << robot.error().what;
  EXPECT_DOUBLE_EQ(robot->model.timestep(), 0.003);
}

TEST(LoadRobot, WhereAModelIsCompiledDoesNotShowInIt) {
  const support::TempFolder folder;
  for (const auto& [name, text] :
       {std::pair("a.xml", std::string(kTwoHinges)),
        std::pair("a.urdf", std::string("<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>"
                                        "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/>"
                                        "<child link=\"b\"/></joint></robot>"))}) {
    const fs::path file = folder.write(name, text);
    const Result<Model> apart = Model::load(file), here = Model::load(file, {.trusted = true});
    ASSERT_TRUE(apart && here) << name;
    EXPECT_EQ(bytes_of(*apart), bytes_of(*here)) << name;
    EXPECT_TRUE(std::ranges::equal(apart->warnings(), here->warnings())) << name;
    EXPECT_EQ(bytes_of(*Model::load(file)), bytes_of(*apart)) << name;
  }
}

TEST(LoadRobot, CopiesShareOneModelAndOutliveTheFirst) {
  std::optional<Robot> robot = load_robot("ur5e").value();
  const Robot copy = *robot;
  EXPECT_EQ(copy.model.raw(), robot->model.raw());
  const std::string before = bytes_of(copy.model);
  robot.reset();
  EXPECT_EQ(bytes_of(copy.model), before);
  EXPECT_EQ(copy.arm.dof(), 6);
}

TEST(LoadRobot, ANameIsThatOfTheShippedModelWhateverLiesInTheFolder) {
  const support::TempFolder folder;
  folder.write("ur5e", kTwoHinges);
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  const auto by_name = find_model_file("ur5e"), by_path = find_model_file("./ur5e");
  fs::current_path(before);
  ASSERT_TRUE(by_name && by_path);
  EXPECT_EQ(by_name->filename(), "scene.xml");
  EXPECT_EQ(*by_path, "./ur5e");
}

TEST(FramePoses, AreMujocosForEveryFrameThatHasAName) {
  const support::TempFolder folder;
  const Model model = Model::load(folder.write("a.xml", kTwoHinges)).value();
  const mjModel* m = model.raw();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
  Rng rng(61);
  for (int n = 0; n < 50; ++n) {
    for (int i = 0; i < m->nq; ++i) d->qpos[i] = rng.uniform(-1, 1);
    mju_normalize4(d->qpos + m->nq - 4);
    mj_kinematics(m, d.get());
    const std::span<const double> qpos(d->qpos, static_cast<std::size_t>(m->nq));
    const auto expect_at = [&](const std::string& frame, const double* p, const double* R) {
      const Result<Pose> X = frame_pose(model, frame, qpos);
      ASSERT_TRUE(X) << frame;
      EXPECT_LT((X->p - Eigen::Vector3d(p)).norm(), 1e-12) << frame;
      using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
      EXPECT_LT((X->R - Eigen::Map<const Rows>(R)).norm(), 1e-12) << frame;
    };
    for (int b = 1; b < m->nbody; ++b) {
      const char* name = mj_id2name(m, mjOBJ_BODY, b);
      if (name != nullptr && std::string_view(name) == "tool0") continue;  // the site goes before
      expect_at(name != nullptr ? name : "#" + std::to_string(b), d->xpos + 3 * b, d->xmat + 9 * b);
    }
    expect_at("tool0", d->site_xpos, d->site_xmat);
  }
  EXPECT_FALSE(frame_pose(model, "", model.qpos0()));
  EXPECT_FALSE(frame_pose(model, "#2", model.qpos0()));  // it has a name
  EXPECT_FALSE(frame_pose(model, "tool0", {}));
}

TEST(FramePoses, AgreeWithTheArmAtHome) {
  for (const char* name : {"ur5e", "panda"}) {
    const testing::TestArm robot = testing::shipped_arm(name);
    std::vector<double> qpos(robot.model.qpos0().begin(), robot.model.qpos0().end());
    for (int i = 0; i < robot.arm.dof(); ++i) {
      const double home = robot.arm.home[i];
      EXPECT_GE(home, robot.arm.limits.lower[i]) << name << i;
      EXPECT_LE(home, robot.arm.limits.upper[i]) << name << i;
      qpos[static_cast<std::size_t>(robot.arm.joints[static_cast<std::size_t>(i)].qpos)] = home;
    }
    // The same tool frame by the whole model and with its load.
    const Pose X = frame_pose(robot.model, robot.arm.tip, qpos).value();
    const Model loaded = robot.model.with_point_mass(robot.arm.tip, 2).value();
    const Pose with_load = frame_pose(loaded, robot.arm.tip, qpos).value();
    EXPECT_EQ(X.p, with_load.p);
    EXPECT_EQ(X.R, with_load.R);
    EXPECT_NEAR(loaded.raw()->body_subtreemass[0], robot.model.raw()->body_subtreemass[0] + 2,
                1e-9);
  }
}

}  // namespace
}  // namespace mjarm
