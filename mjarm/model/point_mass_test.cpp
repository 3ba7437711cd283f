#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <memory>

#include "mjarm/model/model.hpp"
#include "mjarm/model/payload.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

/// Two links, the second with a site; `more` stands in the body of the site.
Model two_links(const std::string& more) {
  const support::TempFolder folder;
  return Model::load(folder.write("arm.xml", R"(<mujoco><compiler angle="radian"/><worldbody>
<body><joint axis="0 1 0.2"/><geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.04" mass="3"/>
<body pos="0.4 0 0"><joint axis="0 0.3 1"/>
<geom type="box" pos="0.1 0.02 0" euler="0.3 0.2 0.1" size="0.1 0.04 0.03" mass="1.5"/>
<site name="tool" pos="0.3 0.05 0.1"/>)" + more + "</body></body></worldbody></mujoco>"))
      .value();
}

/// Accelerations of a falling, turning arm.
std::vector<double> falling(const Model& model) {
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(model.raw()), mj_deleteData);
  d->qpos[0] = 0.3;
  d->qpos[1] = -0.7;
  d->qvel[0] = 1.1;
  d->qvel[1] = -2;
  mj_forward(model.raw(), d.get());
  return {d->qacc[0], d->qacc[1]};
}

TEST(PointMass, MovesLikeABallThatHangsThere) {
  const Model bare = two_links("");
  const Model with_ball = two_links(
      R"(<body pos="0.3 0.05 0.1"><geom type="sphere" size="0.0001" mass="1.2"/></body>)");
  const auto loaded = bare.with_point_mass("tool", 1.2);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  const std::vector<double> expected = falling(with_ball), got = falling(*loaded);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(got[i], expected[i], 1e-5);
  // The model itself is as it was.
  EXPECT_GT(std::abs(falling(bare)[1] - got[1]), 0.1);
}

TEST(PointMass, RefusesWhatIsNoLoad) {
  const Model model = two_links("");
  EXPECT_FALSE(model.with_point_mass("tool", 0).has_value());
  EXPECT_FALSE(model.with_point_mass("tool", std::nan("")).has_value());
  EXPECT_FALSE(model.with_point_mass("tol", 1).has_value());
  EXPECT_FALSE(model.with_point_mass("world", 1).has_value());
}

TEST(Payload, OffTheFrameMovesLikeABallThatHangsThere) {
  const Model bare = two_links("");
  const Model with_ball = two_links(
      R"(<body pos="0.33 0.01 0.12"><geom type="sphere" size="0.0001" mass="0.8"/></body>)");
  const auto loaded = with_payload(bare, "tool", {0.8, {0.03, -0.04, 0.02}});
  ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
  const std::vector<double> expected = falling(with_ball), got = falling(*loaded);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(got[i], expected[i], 1e-5);
}

TEST(Payload, OfNoMassIsNone) {
  const Model bare = two_links("");
  EXPECT_EQ(falling(with_payload(bare, "tool", {}).value()), falling(bare));
  EXPECT_FALSE(with_payload(bare, "tool", {.mass = -1}));
  EXPECT_FALSE(with_payload(bare, "tool", {.mass = 1, .center = {std::nan(""), 0, 0}}));
  EXPECT_FALSE(with_payload(bare, "tol", {.mass = 1}));
  EXPECT_FALSE(with_payload(bare, "world", {.mass = 1}));
}

}  // namespace
}  // namespace mjarm
