#include "mjarm/model/model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#if defined(__linux__)
#include <link.h>
#endif

#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <future>
#include <thread>

#include "mjarm/core/path_list.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;

/// A binary STL of a tetrahedron with edges of length `size` [m].
std::string tetrahedron(float size) {
  const std::array<std::array<float, 3>, 4> corners = {
      {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string file(80, ' ');
  const auto put = [&](const void* bytes, std::size_t count) {
    file.append(static_cast<const char*>(bytes), count);
  };
  const std::uint32_t count = 4;
  put(&count, 4);
  for (const auto& face : faces) {
    const float normal[3] = {0, 0, 0};
    put(normal, 12);
    for (const int corner : face) put(corners[corner].data(), 12);
    file.append(2, '\0');
  }
  return file;
}

std::string one_link(const std::string& shapes, const std::string& extension = "") {
  return "<robot name=\"r\">" + extension + "<link name=\"base\">" + shapes +
         "</link><link name=\"end\"/><joint name=\"j\" type=\"fixed\"><parent link=\"base\"/>"
         "<child link=\"end\"/></joint></robot>";
}
std::string mesh(const char* kind, const std::string& file) {
  return std::string("<") + kind + "><geometry><mesh filename=\"" + file + "\"/></geometry></" +
         kind + ">";
}

/// An environment variable for the life of this object.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
};

constexpr const char* kTwoLinks = R"(<robot name="two">
  <mujoco><compiler angle="degree" strippath="true"/></mujoco>
  <link name="base">
    <visual name="x"><geometry><box size="1 1 1"/></geometry></visual>
    <collision name="x"><geometry><box size="1 1 1"/></geometry></collision>
  </link>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><sphere radius="0.1"/></geometry></visual>
    <visual><geometry><sphere radius="0.2"/></geometry></visual>
  </link>
  <link name="tool"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 2"/>
    <axis xyz="0 0 3"/><limit lower="-1" upper="1.5" velocity="2.5" effort="3"/>
    <dynamics damping="0.5" friction="0.1"/></joint>
  <joint name="flange" type="fixed"><parent link="arm"/><child link="tool"/><origin xyz="1 0 0"/></joint>
</robot>)";

TEST(Model, TellsTheFormatByTheRootElement) {
  const support::TempFolder folder;
  const auto urdf = Model::load(folder.write("named.xml", kTwoLinks));
  ASSERT_TRUE(urdf) << urdf.error().what;
  EXPECT_EQ(urdf->format(), ModelFormat::urdf);
  EXPECT_EQ(urdf->name(), "two");
  const auto mjcf = Model::load(folder.write(
      "named.urdf",
      "<!-- c --><mujoco model=\"m\"><option timestep=\"0.004\"/><worldbody/></mujoco>"));
  ASSERT_TRUE(mjcf) << mjcf.error().what;
  EXPECT_EQ(mjcf->format(), ModelFormat::mjcf);
  EXPECT_EQ(mjcf->name(), "m");
  EXPECT_DOUBLE_EQ(mjcf->timestep(), 0.004);
  EXPECT_EQ(mjcf->nq() + mjcf->nv() + mjcf->nu(), 0);
  EXPECT_EQ(mjcf->file(), folder.path() / "named.urdf");
}

TEST(Model, OfSomebodyElseIsCopied) {
  const Model own = Model::load(find_model_file("ur5e").value()).value();
  mjModel* theirs = mj_copyModel(nullptr, own.raw());
  const Model copy = Model::copy_of(theirs);
  mj_deleteModel(theirs);
  EXPECT_EQ(copy.name(), own.name());
  EXPECT_EQ(copy.nq(), own.nq());
  EXPECT_TRUE(copy.file().empty());
  const Arm arm = find_arm(copy).value();
  EXPECT_EQ(arm.tip, find_arm(own).value().tip);
  EXPECT_EQ(arm.home, find_arm(own).value().home);
}

TEST(Model, UrdfKeepsFixedFramesLimitsAndLooks) {
  const support::TempFolder folder;
  const auto model = Model::load(folder.write("two.urdf", kTwoLinks));
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_DOUBLE_EQ(model->urdf_velocity_limit("turn"), 2.5);
  EXPECT_DOUBLE_EQ(model->urdf_effort_limit("turn"), 3);
  EXPECT_DOUBLE_EQ(model->urdf_velocity_limit("flange"), 0);
  EXPECT_DOUBLE_EQ(model->urdf_velocity_limit("none"), 0);
  const mjModel* m = model->raw();
  ASSERT_EQ(m->njnt, 1);
  EXPECT_DOUBLE_EQ(m->jnt_range[0], -1);  // radian, whatever the extension says
  EXPECT_DOUBLE_EQ(m->jnt_range[1], 1.5);
  EXPECT_DOUBLE_EQ(m->jnt_actfrcrange[1], 3);
  EXPECT_DOUBLE_EQ(m->dof_damping[0], 0.5);
  ASSERT_EQ(m->ngeom, 5);  // three looks and two solids: none lost, none doubled
  int looks = 0;
  for (int g = 0; g < m->ngeom; ++g) looks += m->geom_contype[g] == 0 ? 1 : 0;
  EXPECT_EQ(looks, 3);
  const int base = mj_name2id(m, mjOBJ_BODY, "base");
  const int tool = mj_name2id(m, mjOBJ_BODY, "tool");
  for (int g = 0; g < m->ngeom; ++g) {
    const bool hidden = m->geom_group[g] == 3;
    // The solid of `base` hides behind its look; the tool has no other look than its solid.
    EXPECT_EQ(hidden, m->geom_bodyid[g] == base && m->geom_contype[g] != 0);
    if (m->geom_bodyid[g] == tool) {
      EXPECT_EQ(m->geom_group[g], 2);
    }
  }
  const auto X_WT = frame_pose(*model, "tool", std::vector<double>{1.0});
  ASSERT_TRUE(X_WT) << X_WT.error().what;
  EXPECT_NEAR((X_WT->p - Eigen::Vector3d(std::cos(1), std::sin(1), 2)).norm(), 0, 1e-15);
}

TEST(Model, MimicJointsAreCoupled) {
  const support::TempFolder folder;
  std::string text = kTwoLinks;
  text.replace(
      text.rfind("</robot>"), 8,
      R"(<link name="f"><collision><geometry><sphere radius=".1"/></geometry></collision></link>
    <joint name="follow" type="continuous"><parent link="tool"/><child link="f"/>
    <mimic joint="turn" multiplier="2" offset="0.25"/></joint></robot>)");
  const auto model = Model::load(folder.write("a.urdf", text));
  ASSERT_TRUE(model) << model.error().what;
  ASSERT_EQ(model->raw()->neq, 1);
  EXPECT_DOUBLE_EQ(model->raw()->eq_data[0], 0.25);
  EXPECT_DOUBLE_EQ(model->raw()->eq_data[1], 2);
}

TEST(Model, ShortKeyframesAreFilledFromTheStartWithAWarning) {
  const support::TempFolder folder;
  const auto file = folder.write("a.xml", R"(<mujoco><worldbody>
      <body><joint/><geom size="1"/></body><body pos="5 0 0"><freejoint/><geom size="1"/></body>
    </worldbody><keyframe><key name="home" qpos="0.5"/></keyframe></mujoco>)");
  const Result<Model> model = Model::load(file);
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->raw()->key_qpos[0], 0.5);
  EXPECT_EQ(model->raw()->key_qpos[1], 5);
  ASSERT_EQ(model->warnings().size(), 1U);
  EXPECT_NE(model->warnings()[0].find("\"home\": qpos has 1 values"), std::string::npos)
      << model->warnings()[0];
}

TEST(Model, MeshesAreFoundBesideTheFileAndInPackages) {
  const support::TempFolder folder;
  folder.write("ws/robot_description/meshes/visual/link.stl", tetrahedron(1));
  folder.write("ws/robot_description/meshes/collision/link.stl", tetrahedron(2));
  const std::string package = "package://robot_description/meshes/";
  const auto load = [&](const std::string& place, const std::string& text,
                        const LoadOptions& options = {}) {
    return Model::load(folder.write(place, text), options);
  };
  const std::string relative = one_link(mesh("visual", "../meshes/visual/link.stl") +
                                        mesh("collision", "../meshes/collision/link.stl"));
  const std::string in_package = one_link(mesh("visual", package + "visual/link.stl") +
                                          mesh("collision", package + "collision/link.stl"));
  const auto check = [](const Result<Model>& model, const char* how) {
    ASSERT_TRUE(model) << how << ": " << model.error().what;
    const mjModel* m = model->raw();
    // Two files of one name in two folders stay two meshes.
    ASSERT_EQ(m->nmesh, 2) << how;
    ASSERT_EQ(m->ngeom, 2) << how;
    EXPECT_GT(m->geom_rbound[1], 1.5 * m->geom_rbound[0]) << how;
  };
  check(load("ws/robot_description/urdf/b.urdf", in_package), "walking up");
  EXPECT_FALSE(load("ws/robot_description/own/a.urdf", relative));  // above the file's folder
  check(load("ws/robot_description/urdf/a.urdf", relative), "relative, from the folder urdf");
  folder.write("ws/robot_description/package.xml", "<package/>");
  check(load("ws/robot_description/own/a.urdf", relative), "relative, in its package");
  check(load("ws/other_description/urdf/a.urdf", in_package), "a package beside");
  check(load("else/c.urdf", in_package, {.package_paths = {folder.path() / "ws"}}),
        "option, folder of packages");
  check(
      load("else/c.urdf", in_package, {.package_paths = {folder.path() / "ws/robot_description"}}),
      "option, package");
  EXPECT_FALSE(load("else/c.urdf", in_package));
  {
    const Environment ros("ROS_PACKAGE_PATH", std::string("/nowhere") + kPathListSeparator +
                                                  (folder.path() / "ws").string());
    check(load("else/c.urdf", in_package), "ROS_PACKAGE_PATH");
  }
  {
    fs::create_directories(folder.path() / "prefix/share");
    fs::copy(folder.path() / "ws/robot_description",
             folder.path() / "prefix/share/robot_description", fs::copy_options::recursive);
    const Environment ament("AMENT_PREFIX_PATH", (folder.path() / "prefix").string());
    check(load("else/c.urdf", in_package), "AMENT_PREFIX_PATH");
  }
  const std::string absolute = one_link(
      mesh("visual",
           "file://" + (folder.path() / "ws/robot_description/meshes/visual/link.stl").string()) +
      mesh("collision",
           (folder.path() / "ws/robot_description/meshes/collision/link.stl").string()));
  EXPECT_FALSE(load("else/d.urdf", absolute));
  check(load("else/d.urdf", absolute, {.allow_outside = true}), "absolute");
  const std::string by_dir = one_link(
      mesh("visual", "visual/link.stl") + mesh("collision", "collision/link.stl"),
      "<mujoco><compiler meshdir=\"../ws/robot_description/meshes\" strippath=\"true\"/></mujoco>");
  EXPECT_FALSE(load("else/e.urdf", by_dir));
  check(load("else/e.urdf", by_dir, {.allow_outside = true}), "meshdir");
}

TEST(Model, MeshesOfOtherFormatsAreLeftOutWithAWarning) {
  const support::TempFolder folder;
  folder.write("a.stl", tetrahedron(1));
  const auto model = Model::load(
      folder.write("a.urdf", one_link(mesh("visual", "a.dae") + mesh("visual", "b.DAE") +
                                      mesh("visual", "a.dae") + mesh("collision", "a.stl"))));
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->raw()->ngeom, 1);
  EXPECT_EQ(model->raw()->geom_group[0], 2);  // shown, in place of the look
  ASSERT_EQ(model->warnings().size(), 1U);
  EXPECT_THAT(model->warnings()[0], HasSubstr("a.urdf:1: visual meshes are left out"));
  EXPECT_THAT(model->warnings()[0], EndsWith(": a.dae, b.DAE"));

  const auto bare = Model::load(folder.write("b.urdf", one_link(mesh("collision", "c.dae"))));
  ASSERT_TRUE(bare) << bare.error().what;
  EXPECT_EQ(bare->raw()->ngeom, 0);
  EXPECT_THAT(bare->warnings()[0], HasSubstr("b.urdf:1: collision meshes are left out"));
}

TEST(Model, UrdfJointsHaveMotorsAsStrongAsTheirEffort) {
  const support::TempFolder folder;
  const auto model = Model::load(folder.write(
      "a.urdf",
      R"(<robot name="r"><link name="base"/><link name="a"/><link name="b"/><link name="c"/>
    <joint name="i" type="revolute"><parent link="base"/><child link="a"/>
      <limit lower="-1" upper="1" effort="7" velocity="2"/></joint>
    <joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
    <joint name="k" type="prismatic"><parent link="b"/><child link="c"/>
      <limit lower="0" upper="1" effort="30" velocity="2"/></joint></robot>)"));
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->nu(), 2);
  const Arm arm = find_arm(*model).value();
  ASSERT_EQ(arm.dof(), 2);
  const double efforts[] = {7, 30};
  for (int i = 0; i < 2; ++i) {
    const ArmJoint& joint = arm.joints[i];
    ASSERT_TRUE(joint.actuator) << joint.name;
    EXPECT_EQ(joint.actuator->name, joint.name);
    EXPECT_EQ(joint.actuator->gain, 1);
    EXPECT_EQ(joint.actuator->bias[1], 0);
    EXPECT_EQ(joint.actuator->force_upper, efforts[i]);
    EXPECT_EQ(joint.actuator->force_lower, -efforts[i]);
  }
}

TEST(Model, UrdfWithoutMassStillMoves) {
  const support::TempFolder folder;
  const auto model = Model::load(folder.write(
      "a.urdf",
      R"(<robot name="r"><link name="base"/><link name="a"/><link name="b"/><link name="t"/>
    <joint name="i" type="continuous"><parent link="base"/><child link="a"/></joint>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
    <joint name="k" type="fixed"><parent link="b"/><child link="t"/></joint></robot>)"));
  ASSERT_TRUE(model) << model.error().what;
  ASSERT_EQ(model->warnings().size(), 1U);
  EXPECT_THAT(model->warnings()[0], HasSubstr("a, b (1e-6 kg each)"));
  EXPECT_EQ(find_arm(*model).value().tip, "t");
}

TEST(Model, UrdfWithImpossibleInertiaIsEvenedOutWithAWarning) {
  const support::TempFolder folder;
  std::string text = kTwoLinks;
  text.replace(text.find("izz=\"1\""), 7, "izz=\"5\"");
  const auto model = Model::load(folder.write("a.urdf", text));
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_THAT(model->warnings(),
              ::testing::Contains(::testing::AllOf(HasSubstr("\"arm\""), HasSubstr("evened out"))));
}

TEST(Model, PathsMayHoldSpacesAndChinese) {
  const support::TempFolder folder;
  folder.write("机器 人/网格.stl", tetrahedron(1));
  const auto urdf =
      Model::load(folder.write("机器 人/臂.urdf", one_link(mesh("visual", "网格.stl"))));
  EXPECT_TRUE(urdf) << urdf.error().what;
  const auto mjcf = Model::load(
      folder.write("机器 人/臂.xml",
                   "<mujoco><asset><mesh name=\"m\" file=\"网格.stl\"/></asset><worldbody><geom "
                   "type=\"mesh\" mesh=\"m\"/></worldbody></mujoco>"));
  EXPECT_TRUE(mjcf) << mjcf.error().what;
}

TEST(Model, RelativePathsAreThoseOfTheFileAndNotOfTheProcess) {
  const support::TempFolder folder;
  folder.write("in/part.xml",
               "<mujocoinclude><asset><mesh name=\"m\" file=\"m.stl\"/></asset></mujocoinclude>");
  folder.write("in/m.stl", tetrahedron(1));
  const auto file = folder.write("in/a.xml",
                                 "<mujoco><include file=\"part.xml\"/><worldbody><geom "
                                 "type=\"mesh\" mesh=\"m\"/></worldbody></mujoco>");
  const auto model = Model::load(file);
  EXPECT_TRUE(model) << model.error().what;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  const auto relative = Model::load("in/a.xml");
  fs::current_path(before);
  EXPECT_TRUE(relative) << relative.error().what;
}

TEST(Model, ManyThreadsLoadGoodAndBadFilesAtOnce) {
  const support::TempFolder folder;
  const auto good = folder.write("good.urdf", kTwoLinks);
  constexpr int kThreads = 8;
  std::vector<fs::path> bad;
  for (int i = 0; i < kThreads; ++i) {
    bad.push_back(folder.write(
        "bad" + std::to_string(i) + ".xml",
        "<mujoco><worldbody><geom wrong" + std::to_string(i) + "=\"1\"/></worldbody></mujoco>"));
  }
  // A process of many threads cannot be copied under the sanitizers of GCC 12 and 13: the copy may
  // find their locks taken.
  const LoadOptions options{.trusted = support::kSanitized};
  std::array<std::string, kThreads> wrong;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] {
      const std::string own = "\"wrong" + std::to_string(i) + "\"";
      for (int n = 0; n < 20; ++n) {
        const auto model = Model::load(good, options);
        if (!model) wrong[i] += model.error().what + "\n";
        const auto error = Model::load(bad[i], options);
        if (error) wrong[i] += "loaded\n";
        if (!error && error.error().what.find(own) == std::string::npos)
          wrong[i] += error.error().what + "\n";
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& told : wrong) EXPECT_EQ(told, "");
}

#if defined(__linux__)
TEST(Model, LoadsAlthoughAnotherThreadHoldsTheProgramLoadersLock) {
  if (support::kSanitized) GTEST_SKIP() << "files are not read in a copy of the process";
  const support::TempFolder folder;
  const auto bad =
      folder.write("a.xml", "<mujoco><worldbody><geom wrong=\"1\"/></worldbody></mujoco>");
  const std::string told = Model::load(bad).error().what;
  EXPECT_THAT(told, HasSubstr("wrong"));
  // MuJoCo reports this fault by an exception, whose handler is looked for under that lock: the
  // first copy hangs, since in it nobody gives the lock back.
  std::promise<void> held;
  std::thread other([&] {
    const auto hold = [](dl_phdr_info*, std::size_t, void* told_to) {
      static_cast<std::promise<void>*>(told_to)->set_value();
      std::this_thread::sleep_for(std::chrono::seconds(1));
      return 1;
    };
    ::dl_iterate_phdr(hold, &held);
  });
  held.get_future().wait();
  const auto model = Model::load(bad);
  other.join();
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().what, told);
}
#endif

TEST(ShippedModels, AreFoundByNameAndByEnvironment) {
  for (const char* name : {"car", "hello", "panda", "ur5e", "ur5e_gripper"}) {
    const auto file = find_model_file(name);
    ASSERT_TRUE(file) << file.error().what;
    EXPECT_TRUE(file->is_absolute());
    EXPECT_TRUE(Model::load(*file)) << name;
  }
  std::vector<std::string> names;
  for (const ShippedModel& model : shipped_models()) names.push_back(model.name);
  EXPECT_EQ(names, (std::vector<std::string>{"car", "hello", "panda", "ur5e", "ur5e_gripper"}));
  const support::TempFolder folder;
  folder.write("car.xml", "<mujoco model=\"my car\"/>");
  const Environment models("MJARM_MODELS", folder.path().string());
  EXPECT_EQ(find_model_file("car").value(), folder.path() / "car.xml");
  const Environment nowhere("MJARM_MODELS", (folder.path() / "none").string());
  const auto refused = find_model_file("car");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::usage);
  EXPECT_NE(refused.error().what.find("none: expected a folder"), std::string::npos);
}

TEST(Model, FromATextThatAProgramWrote) {
  const auto model = Model::from_mjcf(
      R"(<mujoco model="made"><worldbody><body><joint/><geom size="0.1"/></body></worldbody></mujoco>)");
  ASSERT_TRUE(model) << model.error().what;
  EXPECT_EQ(model->name(), "made");
  EXPECT_EQ(model->nq(), 1);
  for (const char* bad : {"", "<mujoco>", "<nothing/>",
                          R"(<mujoco><worldbody><geom size="-1"/></worldbody></mujoco>)"}) {
    const auto none = Model::from_mjcf(bad);
    ASSERT_FALSE(none) << bad;
    EXPECT_EQ(none.error().code, Errc::bad_input);
    EXPECT_THAT(none.error().what, HasSubstr("made in memory: "));
    EXPECT_EQ(none.error().what.find('\n'), std::string::npos);
  }
}

TEST(ShippedModels, MissNamesTheNearestAndTheChoices) {
  const auto miss = find_model_file("ur5");
  ASSERT_FALSE(miss);
  EXPECT_EQ(miss.error().code, Errc::bad_input);
  EXPECT_THAT(miss.error().what, HasSubstr("did you mean \"ur5e\""));
  EXPECT_THAT(miss.error().what, HasSubstr("car, hello, panda, ur5e, ur5e_gripper"));
  EXPECT_FALSE(find_model_file(""));
  EXPECT_FALSE(find_model_file("no/such/file.xml"));
  const support::TempFolder folder;
  const auto file = folder.write("a.xml", "<mujoco/>");
  EXPECT_EQ(find_model_file(file.string()).value(), file);
}

TEST(Model, OtherPhysicsLeaveTheRestAsItIs) {
  const Model model =
      Model::from_mjcf(
          "<mujoco><option timestep='0.002'/><worldbody><geom name='a' size='1' friction='0.8 0.1 "
          "0.2'/><body><freejoint/><geom name='b' size='1' mass='3'/></body></worldbody><contact>"
          "<pair geom1='a' geom2='b' friction='1 2 3 4 5'/></contact></mujoco>")
          .value();
  const Model other = model.with_physics({.timestep = 1e-4, .friction = 0.5}).value();
  EXPECT_EQ(other.timestep(), 1e-4);
  EXPECT_EQ(model.timestep(), 2e-3);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(other.raw()->geom_friction[i], 0.5 * model.raw()->geom_friction[i]);
  }
  for (int i = 0; i < 5; ++i) EXPECT_EQ(other.raw()->pair_friction[i], 0.5 * (i + 1));
  EXPECT_EQ(other.raw()->body_mass[1], 3);
  EXPECT_EQ(model.with_physics({}).value().timestep(), model.timestep());
  for (const PhysicsChange& bad : {PhysicsChange{.timestep = 0}, PhysicsChange{.timestep = NAN},
                                   PhysicsChange{.friction = -1}}) {
    const auto refused = model.with_physics(bad);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::bad_input);
  }
}

}  // namespace
}  // namespace mjarm
