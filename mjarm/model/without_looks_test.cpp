// Models without what is only seen move as they do with it.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;

/// Everything that matters to motion, number by number.
void expect_alike(const mjModel& a, const mjModel& b) {
  ASSERT_EQ(a.nbody, b.nbody);
  ASSERT_EQ(a.njnt, b.njnt);
  ASSERT_EQ(a.nu, b.nu);
  ASSERT_EQ(a.nsite, b.nsite);
  ASSERT_EQ(a.nkey, b.nkey);
  ASSERT_EQ(a.npair, b.npair);
  ASSERT_EQ(a.nexclude, b.nexclude);
  ASSERT_EQ(a.nsensor, b.nsensor);
  const auto same = [&](const auto* x, const auto* y, auto count, const char* what) {
    EXPECT_TRUE(std::equal(x, x + count, y)) << what;
  };
  same(a.body_mass, b.body_mass, a.nbody, "mass");
  same(a.body_inertia, b.body_inertia, 3 * a.nbody, "inertia");
  same(a.body_ipos, b.body_ipos, 3 * a.nbody, "centre of mass");
  same(a.body_iquat, b.body_iquat, 4 * a.nbody, "axes of inertia");
  same(a.body_pos, b.body_pos, 3 * a.nbody, "place");
  same(a.jnt_range, b.jnt_range, 2 * a.njnt, "range");
  same(a.key_qpos, b.key_qpos, a.nkey * a.nq, "keyframes");
  same(a.actuator_gainprm, b.actuator_gainprm, mjNGAIN * a.nu, "gains");
  int colliding_a = 0, colliding_b = 0;
  for (int g = 0; g < a.ngeom; ++g) colliding_a += a.geom_contype[g] || a.geom_conaffinity[g];
  for (int g = 0; g < b.ngeom; ++g) colliding_b += b.geom_contype[g] || b.geom_conaffinity[g];
  EXPECT_EQ(colliding_a, colliding_b);
}

void expect_alike(const fs::path& file) {
  const auto whole = Model::load(file), bare = Model::load(file, {.looks = false});
  ASSERT_TRUE(whole) << whole.error().what;
  ASSERT_TRUE(bare) << bare.error().what;
  expect_alike(*whole->raw(), *bare->raw());
}

TEST(WithoutLooks, ShippedModelsMoveAlikeAndAreSmaller) {
  for (const char* name : {"ur5e", "panda"}) {
    const fs::path file = find_model_file(name).value();
    expect_alike(file);
    const Model whole = Model::load(file).value(),
                bare = Model::load(file, {.looks = false}).value();
    EXPECT_LT(bare.raw()->ngeom, whole.raw()->ngeom);
    EXPECT_LT(bare.raw()->nbuffer, whole.raw()->nbuffer / 4);
  }
  expect_alike(find_model_file("panda").value().parent_path() / "panda.urdf");
}

/// Masses that come from geoms which are only seen, and geoms that are only seen but needed.
TEST(WithoutLooks, WhatIsNeededStays) {
  const support::TempFolder folder;
  const fs::path file = folder.write("needed.xml", R"(<mujoco><worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="a" pos="0 0 1"><joint name="turn" axis="0 1 0"/>
      <geom name="weight" type="box" size="0.1 0.2 0.3" mass="2" contype="0" conaffinity="0"/>
      <geom name="paint" type="sphere" size="0.1" mass="0" contype="0" conaffinity="0"/>
      <body name="b" pos="0.5 0 0"><joint name="bend" axis="0 1 0"/>
        <geom name="pulley" type="sphere" size="0.05" contype="0" conaffinity="0"/>
        <geom name="hand" type="sphere" size="0.1"/>
        <geom name="chosen" type="sphere" size="0.1" pos="0.2 0 0" contype="0" conaffinity="0"/>
        <site name="s" pos="0.1 0 0"/></body></body>
    <site name="t" pos="0 0 2"/></worldbody>
    <tendon><spatial name="rope"><site site="t"/><geom geom="pulley"/><site site="s"/></spatial></tendon>
    <contact><pair geom1="chosen" geom2="floor"/></contact>
    <actuator><position joint="turn"/><motor tendon="rope"/></actuator>
    <sensor><distance geom1="weight" geom2="floor"/></sensor></mujoco>)");
  expect_alike(file);
  const Model bare = Model::load(file, {.looks = false}).value();
  const auto has = [&](const char* name) { return mj_name2id(bare.raw(), mjOBJ_GEOM, name) >= 0; };
  EXPECT_TRUE(has("pulley") && has("chosen") && has("hand") && has("floor"));
}

}  // namespace
}  // namespace mjarm
