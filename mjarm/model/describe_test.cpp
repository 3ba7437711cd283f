#include "mjarm/model/describe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace mjarm {
namespace {

using ::testing::Contains;
using ::testing::Field;

TEST(Describe, Panda) {
  const Model model = Model::load(find_model_file("panda").value()).value();
  const ModelInfo info = describe(model);
  EXPECT_EQ(info.name, "panda scene");
  EXPECT_DOUBLE_EQ(info.timestep, 0.002);
  EXPECT_DOUBLE_EQ(info.gravity.z(), -9.81);
  ASSERT_FALSE(info.bodies.empty());
  EXPECT_EQ(info.bodies[0].name, "world");
  EXPECT_EQ(info.bodies[0].parent, -1);
  double mass = 0;
  int joints = 0;
  for (std::size_t b = 1; b < info.bodies.size(); ++b) {
    const BodyInfo& body = info.bodies[b];
    EXPECT_LT(body.parent, static_cast<int>(b));
    EXPECT_EQ(body.depth, info.bodies[body.parent].depth + 1);
    mass += body.mass;
    for (const JointInfo& joint : body.joints) EXPECT_EQ(joint.qpos, joints++);
  }
  EXPECT_EQ(joints, model.nq());
  EXPECT_NEAR(mass, info.mass, 1e-12);
  const auto hand = std::find_if(info.bodies.begin(), info.bodies.end(),
                                 [](const BodyInfo& b) { return b.name == "hand"; });
  ASSERT_NE(hand, info.bodies.end());
  EXPECT_THAT(hand->sites, Contains("hand_tcp"));
  EXPECT_THAT(hand->geoms, Contains(Field(&GeomInfo::collides, true)));
  EXPECT_THAT(info.frames, Contains(::testing::AllOf(Field(&FrameInfo::name, "hand_tcp"),
                                                     Field(&FrameInfo::is_site, true),
                                                     Field(&FrameInfo::body, "hand"))));
  EXPECT_THAT(info.frames, Contains(::testing::AllOf(Field(&FrameInfo::name, "link3"),
                                                     Field(&FrameInfo::is_site, false))));
  ASSERT_EQ(info.actuators.size(), 8U);
  EXPECT_EQ(info.actuators[0].drives, "joint");
  EXPECT_EQ(info.actuators[0].target, "joint1");
  EXPECT_EQ(info.actuators[7].drives, "tendon");
  EXPECT_EQ(info.actuators[7].target, "split");
  EXPECT_DOUBLE_EQ(info.actuators[7].ctrl_upper, 255);
  EXPECT_DOUBLE_EQ(info.actuators[7].force_lower, -100);
  ASSERT_EQ(info.keyframes.size(), 1U);
  EXPECT_EQ(info.keyframes[0].name, "home");
  EXPECT_EQ(info.keyframes[0].qpos.size(), 9U);
}

TEST(Describe, CarHasAFreeJointAndSensors) {
  const ModelInfo info = describe(Model::load(find_model_file("car").value()).value());
  EXPECT_THAT(info.bodies,
              Contains(Field(&BodyInfo::joints, Contains(Field(&JointInfo::type, "free")))));
  EXPECT_EQ(info.sensors.size(), 2U);
  EXPECT_EQ(info.meshes, 1);
}

}  // namespace
}  // namespace mjarm
