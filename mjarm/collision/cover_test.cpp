#include "mjarm/collision/cover.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>

#include "mjarm/collision/cover_robots_test.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using testing::CoveredRobot;

/// A slide along x with a turn about z at its end, which carries `carried`; `things` stand round
/// it.
CoveredRobot two_joints(const std::string& things, const std::string& carried,
                        const std::string& rest = "") {
  const support::TempFolder folder;
  const std::string xml =
      R"(<mujoco model="two"><compiler angle="radian"/><worldbody>)" + things +
      R"(<body name="cart"><joint name="x" type="slide" axis="1 0 0" range="-1 1"/>
         <geom name="rail" type="capsule" size="0.02" fromto="-0.1 0 0 0.1 0 0"/>
         <body name="hand" pos="0 0 0.1"><joint name="turn" type="hinge" axis="0 0 1" range="-2 2"/>
         )" +
      carried + R"(<site name="tip"/></body></body></worldbody>)" + rest + "</mujoco>";
  return testing::covered_file(folder.write("two.xml", xml), "tip");
}

ModelCover cover_of(const CoveredRobot& robot, const CoverOptions& options = {}) {
  const auto cover = cover_model(robot.model, robot.arm, options);
  EXPECT_TRUE(cover.has_value()) << cover.error().what;
  return cover.value();
}

int link_named(const ModelCover& cover, const std::string& name) {
  for (std::size_t i = 0; i < cover.spheres.links.size(); ++i) {
    if (cover.spheres.links[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

bool contains(const LinkSpheres& link, const Eigen::Vector3d& p_J) {
  return std::any_of(link.spheres.begin(), link.spheres.end(), [&](const Sphere& sphere) {
    return (sphere.center - p_J).norm() <= sphere.radius;
  });
}

TEST(CoverModel, LinksAndSceneFollowTheRulesOfTheModel) {
  const CoveredRobot robot = two_joints(
      R"(<geom name="post" type="box" size="0.1 0.1 0.5" pos="0.5 0.3 0"/>
         <geom name="ghost" type="sphere" size="0.1" contype="0" conaffinity="0"/>
         <geom name="lamp" type="sphere" size="0.1" pos="0 0.3 0.1" contype="2" conaffinity="2"/>)",
      R"(<geom name="palm" type="box" size="0.02 0.25 0.01"/>
         <geom name="probe" type="sphere" size="0.02" pos="0 0.25 0" contype="2" conaffinity="2"/>
         <geom name="paint" type="sphere" size="0.3" contype="0" conaffinity="0"/>)");
  const ModelCover cover = cover_of(robot);
  ASSERT_EQ(cover.spheres.links.size(), 3U);  // cart, palm, and the probe with masks of its own
  const int cart = link_named(cover, "cart"), hand = link_named(cover, "hand");
  const int probe = link_named(cover, "probe");
  ASSERT_TRUE(cart >= 0 && hand >= 0 && probe >= 0);
  EXPECT_EQ(cover.spheres.links[static_cast<std::size_t>(cart)].joint, 0);
  EXPECT_EQ(cover.spheres.links[static_cast<std::size_t>(hand)].joint, 1);
  EXPECT_TRUE(cover.spheres.pairs.empty());  // parent and child
  ASSERT_EQ(cover.scene.solids.size(), 2U);
  EXPECT_EQ(cover.scene.solids[0].name, "post");
  EXPECT_EQ(cover.scene.solids[1].name, "lamp");
  const auto ignored = [&](int link, int obstacle) {
    const auto& all = cover.scene.ignored;
    return std::find(all.begin(), all.end(), IgnoredPair{link, obstacle}) != all.end();
  };
  EXPECT_FALSE(ignored(hand, 0));
  EXPECT_TRUE(ignored(probe, 0));
  EXPECT_FALSE(ignored(probe, 1));
  EXPECT_TRUE(ignored(hand, 1));
  EXPECT_TRUE(ignored(cart, 1));
}

TEST(CoverModel, SameTwice) {
  const CoveredRobot robot = testing::covered_robot("ur5e");
  const ModelCover a = cover_of(robot), b = cover_of(robot);
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  EXPECT_EQ(a.spheres.pairs, b.spheres.pairs);
  for (std::size_t i = 0; i < a.spheres.links.size(); ++i) {
    for (std::size_t k = 0; k < a.spheres.links[i].spheres.size(); ++k) {
      EXPECT_EQ(a.spheres.links[i].spheres[k].center, b.spheres.links[i].spheres[k].center);
      EXPECT_EQ(a.spheres.links[i].spheres[k].radius, b.spheres.links[i].spheres[k].radius);
    }
  }
}

TEST(CoverModel, ShippedRobotsNeedFewSpheres) {
  for (const auto& [name, max] : {std::pair{"ur5e", 42U}, std::pair{"panda", 105U}}) {
    const ModelCover cover = cover_of(testing::covered_robot(name));
    EXPECT_LE(cover.spheres.size(), max) << name;
    EXPECT_LE(cover.bound, 0.012 + 1e-9) << name;
    EXPECT_FALSE(cover.scene.solids.empty()) << name;  // the floor
  }
  const ModelCover panda = cover_of(testing::covered_robot("panda"));
  EXPECT_FALSE(panda.standing.empty());  // link0, on the floor
  for (const int i : panda.standing) {
    EXPECT_EQ(panda.scene.solids[static_cast<std::size_t>(i)].name.substr(0, 5), "link0");
  }
}

TEST(CoverModel, ThingsInTheHandAreCoveredWithIt) {
  const CoveredRobot robot =
      two_joints(R"(<geom name="wall" type="box" size="0.1 1 1" pos="2 0 0"/>)",
                 R"(<geom name="palm" type="sphere" size="0.02"/>
         <body name="cup" pos="0 0.3 0"><geom name="cup" type="cylinder" size="0.04 0.06"/></body>)");
  const ModelCover cover = cover_of(robot);
  const int hand = link_named(cover, "hand");
  ASSERT_GE(hand, 0);
  const LinkSpheres& link = cover.spheres.links[static_cast<std::size_t>(hand)];
  for (int k = 0; k < 36; ++k) {
    for (const double z : {-0.06, 0.0, 0.06}) {
      EXPECT_TRUE(contains(link, {0.04 * std::cos(k), 0.3 + 0.04 * std::sin(k), z}));
    }
  }
}

TEST(CoverModel, AGripperIsCoveredInItsPosture) {
  const CoveredRobot robot =
      two_joints(R"(<geom name="wall" type="box" size="0.1 1 1" pos="2 0 0"/>)",
                 R"(<geom name="palm" type="sphere" size="0.02"/>
         <body name="jaw" pos="0 0 0.1"><joint name="jaw" type="slide" axis="0 1 0" range="0 0.2"/>
         <geom name="jaw" type="sphere" size="0.01"/>
         <body name="claw" pos="0 0 0.1"><joint name="claw" axis="1 0 0" range="0 1"/>
         <geom name="claw" type="sphere" size="0.01" pos="0 0 0.1"/></body></body>)");
  const auto jaw = [](double stroke) { return Eigen::Vector3d(0, stroke, 0.1); };
  const auto claw = [&](double stroke, double angle) -> Eigen::Vector3d {
    return jaw(stroke) + Eigen::Vector3d(0, -0.1 * std::sin(angle), 0.1 + 0.1 * std::cos(angle));
  };
  std::vector<double> open(static_cast<std::size_t>(robot.model.nq()), 0.0);
  open[2] = 0.15;
  const auto hand_of = [&](const CoverOptions& options) {
    const ModelCover cover = cover_of(robot, options);
    EXPECT_LE(cover.bound, options.bound + 1e-9);
    return cover.spheres.links[static_cast<std::size_t>(link_named(cover, "jaw"))];
  };
  const LinkSpheres closed = hand_of({});
  EXPECT_TRUE(contains(closed, jaw(0)) && contains(closed, claw(0, 0)));
  EXPECT_FALSE(contains(closed, jaw(0.15)));
  const LinkSpheres opened = hand_of({.qpos = open});
  EXPECT_TRUE(contains(opened, jaw(0.15)) && contains(opened, claw(0.15, 0)));
  EXPECT_FALSE(contains(opened, jaw(0)));
}

TEST(CoverModel, ABoundThatTakesTooManySpheresIsWidened) {
  const CoveredRobot robot =
      two_joints(R"(<geom name="wall" type="box" size="0.1 1 1" pos="4 0 0"/>)",
                 R"(<geom name="board" type="box" size="0.5 0.4 0.01"/>)");
  const ModelCover cover = cover_of(robot, {.bound = 0.005});
  EXPECT_LE(cover.spheres.size(), kMaxSpheres);
  EXPECT_GT(cover.bound, 0.005);
  const LinkSpheres& board =
      cover.spheres.links[static_cast<std::size_t>(link_named(cover, "hand"))];
  for (double x = -0.5; x <= 0.5; x += 0.02) {
    for (double y = -0.4; y <= 0.4; y += 0.02) EXPECT_TRUE(contains(board, {x, y, 0.01}));
  }
}

TEST(CoverModel, PairsThatNeverMeetAreLeftOut) {
  // The hand turns above the cart's rail at 50 mm; the cart slides along a table 1 mm below it.
  const CoveredRobot robot = two_joints(
      R"(<geom name="table" type="box" size="2 0.5 0.1" pos="0 0 -0.121"/>
         <geom name="block" type="box" size="0.1 0.1 0.1" pos="0.6 0 0"/>)",
      R"(<geom name="palm" type="box" size="0.2 0.02 0.01"/>)");
  const ModelCover cover = cover_of(robot);
  ASSERT_EQ(cover.scene.solids.size(), 1U);  // not the table
  EXPECT_EQ(cover.scene.solids[0].name, "block");
  EXPECT_GE(cover.pairs_apart, 2);
}

TEST(CoverModel, EllipsoidsAreBoxesInTheScene) {
  const CoveredRobot robot =
      two_joints(R"(<geom name="egg" type="ellipsoid" size="0.1 0.2 0.05" pos="0.5 0 0.1"/>)",
                 R"(<geom name="palm" type="sphere" size="0.02"/>)");
  const ModelCover cover = cover_of(robot);
  ASSERT_EQ(cover.scene.solids.size(), 1U);
  const auto& box = std::get<BoxShape>(cover.scene.solids[0].shape);
  EXPECT_LT((box.half - Eigen::Vector3d(0.1, 0.2, 0.05)).norm(), 1e-6);
}

void expect_fault(const Model& model, const Arm& arm, const CoverOptions& options,
                  const std::string& word) {
  const auto cover = cover_model(model, arm, options);
  ASSERT_FALSE(cover.has_value()) << word;
  EXPECT_NE(cover.error().what.find(word), std::string::npos) << cover.error().what;
  EXPECT_EQ(cover.error().what.find('\n'), std::string::npos);
}

TEST(CoverModel, SaysWhatIsWrong) {
  const CoveredRobot robot = testing::covered_robot("ur5e");
  const CoveredRobot other = testing::covered_robot("panda");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bound : {0.0, -1.0, nan, 2.0}) {
    expect_fault(robot.model, robot.arm, {.bound = bound}, "bound");
  }
  expect_fault(robot.model, robot.arm, {.qpos = {1, 2}}, "qpos");
  std::vector<double> q(static_cast<std::size_t>(robot.model.nq()), 0.0);
  q[0] = nan;
  expect_fault(robot.model, robot.arm, {.qpos = q}, "qpos");
  expect_fault(robot.model, other.arm, {}, "panda");
  expect_fault(other.model, robot.arm, {}, "ur5e");
  expect_fault(robot.model, testing::ur5e(), {}, "ur5e");
  expect_fault(robot.model, Arm(), {}, "arm");
  const CoveredRobot bare =
      two_joints("", R"(<geom type="sphere" size="0.1"/>)",
                 R"(<contact><exclude body1="cart" body2="hand"/></contact>)");
  expect_fault(bare.model, bare.arm, {}, "no geom");
}

}  // namespace
}  // namespace mjarm
