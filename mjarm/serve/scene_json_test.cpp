#include "mjarm/serve/scene_json.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cstring>

#include "mjarm/core/json.hpp"
#include "mjarm/model/shipped_test.hpp"

namespace mjarm::serve {
namespace {

SceneFacts facts_of(const Model& model) {
  SceneFacts facts{.title = "mjarm \"test\"",
                   .name = std::string(model.name()),
                   .view = render::default_view(model),
                   .nq = model.nq()};
  for (int dof = 0; dof < model.nv(); ++dof) facts.jog_dofs.push_back(dof);
  return facts;
}

JsonObject scene_of(const std::string& text) {
  Result<JsonObject> object = parse_json_object(text);
  EXPECT_TRUE(object) << (object ? "" : object.error().what);
  return std::move(*object);
}

class SceneJson : public ::testing::TestWithParam<const char*> {};

TEST_P(SceneJson, SaysWhatMuJoCoHas) {
  const Model model = mjarm::testing::shipped(GetParam());
  const mjModel& m = *model.raw();
  const DrawnModel drawn = drawn_model(model);
  EXPECT_EQ(drawn.left_out, 0);
  const JsonObject scene = scene_of(scene_json(drawn, facts_of(model)));
  EXPECT_EQ(scene->find("protocol")->whole(), 1U);
  EXPECT_EQ(scene->find("title")->string(), "mjarm \"test\"");
  EXPECT_EQ(scene->find("nq")->whole(), static_cast<std::uint64_t>(m.nq));
  EXPECT_EQ(scene->find("bodies")->size(), static_cast<std::size_t>(m.nbody));
  ASSERT_EQ(scene->find("masses")->size(), static_cast<std::size_t>(m.nbody));
  for (int body = 0; body < m.nbody; ++body) {
    const double mass = (*scene->find("masses"))[static_cast<std::size_t>(body)].number();
    EXPECT_EQ(mass, m.body_weldid[body] != 0 ? m.body_mass[body] : 0);
  }
  EXPECT_EQ(scene->find("cameras")->size(), static_cast<std::size_t>(m.ncam));
  const JsonValue& geoms = *scene->find("geoms");
  ASSERT_EQ(geoms.size(), drawn.geoms.size());
  for (std::size_t i = 0; i < geoms.size(); ++i) {
    const int id = drawn.geoms[i].id;
    EXPECT_EQ(geoms[i].find("body")->number(), m.geom_bodyid[id]);
    const auto pos = number_list(geoms[i], "pos", 3);
    const auto quat = number_list(geoms[i], "quat", 4);
    ASSERT_TRUE(pos && quat);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR((*pos)[k], m.geom_pos[3 * id + static_cast<int>(k)], 1e-9);
    double dot = 0;
    for (std::size_t k = 0; k < 4; ++k)
      dot += (*quat)[k] * m.geom_quat[4 * id + static_cast<int>(k)];
    EXPECT_NEAR(std::abs(dot), 1, 1e-9);
    const bool is_mesh = m.geom_type[id] == mjGEOM_MESH;
    EXPECT_EQ(geoms[i].find("kind")->string() == "mesh", is_mesh);
    EXPECT_EQ(geoms[i].contains("mesh"), is_mesh);
    if (is_mesh) {
      EXPECT_LT(geoms[i].find("mesh")->whole(), drawn.meshes.size());
    }
  }
}

TEST_P(SceneJson, HasASliderForEachJointThatMayBeMoved) {
  const Model model = mjarm::testing::shipped(GetParam());
  const mjModel& m = *model.raw();
  SceneFacts facts = facts_of(model);
  const DrawnModel drawn = drawn_model(model);
  const JsonObject scene = scene_of(scene_json(drawn, facts));
  const JsonValue& joints = *scene->find("options")->find("joints");
  ASSERT_EQ(joints.size(), slider_joints(drawn, facts).size());
  for (const JsonValue& joint : joints) {
    const int id = m.dof_jntid[joint.find("dof")->whole()];
    EXPECT_EQ(joint.find("lower")->is_null(), m.jnt_limited[id] == 0);
    EXPECT_EQ(joint.find("angle")->boolean(), m.jnt_type[id] == mjJNT_HINGE);
    EXPECT_EQ(joint.find("qpos")->number(), m.jnt_qposadr[id]);
  }
  facts.jog_dofs.clear();
  EXPECT_TRUE(slider_joints(drawn, facts).empty());
}

INSTANTIATE_TEST_SUITE_P(Shipped, SceneJson, ::testing::Values("ur5e", "panda", "car"),
                         [](const auto& shown) { return std::string(shown.param); });

TEST(SceneMeshes, AreBytesOfTheirVerticesAndTriangles) {
  const DrawnMesh mesh{{0, 0, 0, 1, 0, 0, 0, 1.5F, 0}, {0, 1, 2}};
  const std::string bytes = mesh_bytes(mesh);
  ASSERT_EQ(bytes.size(), 8U + 9 * 4 + 3 * 4);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\3\0\0\0\1\0\0\0", 8));
  float y = 0;
  std::memcpy(&y, bytes.data() + 8 + 7 * 4, sizeof(y));
  EXPECT_EQ(y, 1.5F);
  EXPECT_EQ(bytes.substr(8 + 9 * 4 + 8), std::string("\2\0\0\0", 4));
}

TEST(DrawnModels, AMeshIsWhereItsFileHasIt) {
  // MuJoCo moves the vertices into a frame at the centre of mass, and the geom with it.
  const Result<Model> model = Model::from_mjcf(R"(<mujoco><asset>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 2 0  0 0 3"/></asset><worldbody>
    <geom type="mesh" mesh="wedge" pos="5 0 0"/><geom type="mesh" mesh="wedge"/>
    </worldbody></mujoco>)");
  ASSERT_TRUE(model) << model.error().what;
  const DrawnModel drawn = drawn_model(*model);
  ASSERT_EQ(drawn.geoms.size(), 2U);
  ASSERT_EQ(drawn.meshes.size(), 1U);  // once for both
  const DrawnMesh& mesh = drawn.meshes[0];
  EXPECT_EQ(mesh.corners.size(), 12U);
  Eigen::Vector3d low(9, 9, 9), high(-9, -9, -9);
  for (std::size_t i = 0; i < mesh.xyz.size(); i += 3) {
    const Eigen::Vector3d p =
        drawn.geoms[0].X_BG * Eigen::Vector3d(mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_NEAR((low - Eigen::Vector3d(5, 0, 0)).norm(), 0, 1e-5);
  EXPECT_NEAR((high - Eigen::Vector3d(6, 2, 3)).norm(), 0, 1e-5);
  SceneFacts facts;
  const JsonObject scene = scene_of(scene_json(drawn, facts));
  EXPECT_EQ((*scene->find("geoms"))[1].find("mesh")->whole(), 0U);
  EXPECT_EQ((*scene->find("meshes"))[0].find("triangles")->whole(), 4U);
}

TEST(DrawnModels, HeightFieldsPlanesTexturesAndJoints) {
  const Result<Model> model = Model::from_mjcf(R"(<mujoco><asset>
    <hfield name="hill" nrow="3" ncol="4" size="2 1 0.5 0.1" elevation="0 0 0 0  0 1 1 0  0 0 0 0"/>
    <texture name="flat" type="2d" builtin="flat" rgb1="1 0 0" width="4" height="4"/>
    <material name="red" texture="flat"/>
    </asset><worldbody>
    <geom type="plane" size="0 0 1"/>
    <geom type="hfield" hfield="hill" pos="0 0 -1"/>
    <body name="box"><joint name="turn" type="hinge" axis="0 0 1"/>
      <geom name="side" type="box" size=".1 .2 .3" material="red" group="4"/>
      <geom type="sphere" size=".1" rgba="1 1 1 0"/></body>
    </worldbody></mujoco>)");
  ASSERT_TRUE(model) << model.error().what;
  const DrawnModel drawn = drawn_model(*model);
  ASSERT_EQ(drawn.geoms.size(), 3U);  // without the one that is transparent
  EXPECT_EQ(drawn.geoms[0].shape, DrawnShape::plane);
  EXPECT_EQ(drawn.geoms[0].size, Eigen::Vector3d::Zero());
  EXPECT_EQ(drawn.geoms[1].shape, DrawnShape::mesh);
  ASSERT_EQ(drawn.meshes.size(), 1U);
  EXPECT_EQ(drawn.meshes[0].xyz.size(), 3U * 12);
  EXPECT_EQ(drawn.meshes[0].corners.size(), 3U * 2 * 2 * 3);
  EXPECT_FLOAT_EQ(drawn.meshes[0].xyz[0], -2);
  EXPECT_FLOAT_EQ(drawn.meshes[0].xyz[3 * 5 + 2], 0.5F);
  EXPECT_EQ(drawn.geoms[2].name, "side");
  EXPECT_EQ(drawn.geoms[2].group, 4);
  EXPECT_GT(drawn.geoms[2].rgba[0], 0.9F);
  EXPECT_LT(drawn.geoms[2].rgba[1], 0.1F);
  ASSERT_EQ(drawn.joints.size(), 1U);
  EXPECT_TRUE(std::isinf(drawn.joints[0].upper));
  EXPECT_FALSE(drawn.bodies[0].moves);
  EXPECT_TRUE(drawn.bodies[1].moves);
}

}  // namespace
}  // namespace mjarm::serve
