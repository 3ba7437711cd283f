#include "mjarm/collision/exact.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>

#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/core/messages.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

/// An arm of slides that carries a ball along x, y, z; with fixed things around it.
std::string slider(const std::string& things, const std::string& carried) {
  return R"(<mujoco model="slider"><compiler angle="radian"/><worldbody>)" + things +
         R"(<body name="x"><joint name="jx" type="slide" axis="1 0 0" range="-5 5"/>
              <geom name="gx" type="sphere" size="0.01" contype="0" conaffinity="0"/>
            <body name="y"><joint name="jy" type="slide" axis="0 1 0" range="-5 5"/>
              <geom name="gy" type="sphere" size="0.01" contype="0" conaffinity="0"/>
            <body name="z"><joint name="jz" type="slide" axis="0 0 1" range="-5 5"/>)" +
         carried + R"(<site name="tip"/></body></body></body>
         </worldbody></mujoco>)";
}

struct World {
  Model model;
  Arm arm;
};

World load(const support::TempFolder& folder, const std::string& xml) {
  const auto model = Model::load(folder.write("model.xml", xml));
  EXPECT_TRUE(model.has_value()) << model.error().what;
  const auto arm = find_arm(model.value(), {.tip = "tip"});
  EXPECT_TRUE(arm.has_value()) << arm.error().what;
  return {model.value(), arm.value()};
}

CollisionReport check(ExactChecker& checker, std::initializer_list<double> q) {
  const auto report = checker.check(std::vector<double>(q));
  EXPECT_TRUE(report.has_value());
  EXPECT_EQ(report->free, checker.is_free(std::vector<double>(q)));
  return *report;
}

TEST(ExactChecker, TwoSpheres) {
  const support::TempFolder folder;
  const World world = load(folder, slider(R"(<geom name="rock" type="sphere" size="0.3"/>)",
                                          R"(<geom name="ball" type="sphere" size="0.2"/>)"));
  ExactChecker checker(world.model, world.arm);
  Rng rng(71);
  int touching = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5));
    const CollisionReport report = check(checker, {p.x(), p.y(), p.z()});
    const double gap = p.norm() - 0.5;
    EXPECT_EQ(report.free, gap >= 0);
    ASSERT_EQ(report.contacts.size(), gap < 0 ? 1U : 0U);
    ASSERT_EQ(report.nearest.has_value(), gap < 0.1);
    if (report.nearest) {
      EXPECT_NEAR(report.nearest->distance, gap, 1e-9);
    }
    if (gap >= 0) continue;
    ++touching;
    const ContactPoint& contact = report.contacts[0];
    EXPECT_NEAR(contact.depth, -gap, 1e-9);
    EXPECT_EQ((std::set<std::string>{contact.pair.geom1, contact.pair.geom2}),
              (std::set<std::string>{"ball", "rock"}));
    const double sign = contact.pair.geom1 == "rock" ? 1 : -1;
    EXPECT_LT((sign * contact.normal_W - p.normalized()).norm(), 1e-6);
    EXPECT_LT((contact.point_W - p.normalized() * (p.norm() + 0.1) / 2).norm(), 1e-6);
  }
  EXPECT_GT(touching, 100);
}

/// Distance between two segments, by alternating projections on a convex problem.
double segment_distance(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1,
                        const Eigen::Vector3d& b0, const Eigen::Vector3d& b1) {
  const auto nearest = [](const Eigen::Vector3d& p, const Eigen::Vector3d& s0,
                          const Eigen::Vector3d& s1) -> Eigen::Vector3d {
    const Eigen::Vector3d along = s1 - s0;
    return s0 + along * std::clamp((p - s0).dot(along) / along.squaredNorm(), 0.0, 1.0);
  };
  Eigen::Vector3d p = a0, r = b0;
  for (int i = 0; i < 5000; ++i) {
    r = nearest(p, b0, b1);
    p = nearest(r, a0, a1);
  }
  return (p - r).norm();
}

TEST(ExactChecker, TwoCapsules) {
  const support::TempFolder folder;
  const World world = load(
      folder,
      slider(R"(<geom name="pole" type="capsule" size="0.05" fromto="-0.4 0.1 0 0.5 -0.1 0.2"/>)",
             R"(<geom name="rod" type="capsule" size="0.04" fromto="-0.1 -0.3 0 0.1 0.3 0.1"/>)"));
  ExactChecker checker(world.model, world.arm, {.margin = 0.3});
  Rng rng(72);
  int measured = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p(rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(-0.4, 0.4));
    const double gap =
        segment_distance({-0.4, 0.1, 0}, {0.5, -0.1, 0.2}, p + Eigen::Vector3d(-0.1, -0.3, 0),
                         p + Eigen::Vector3d(0.1, 0.3, 0.1)) -
        0.09;
    const CollisionReport report = check(checker, {p.x(), p.y(), p.z()});
    if (std::abs(gap) > 1e-6) {
      EXPECT_EQ(report.free, gap > 0);
    }
    if (gap > 0.299 || gap < -0.08) continue;
    ++measured;
    ASSERT_TRUE(report.nearest.has_value());
    EXPECT_NEAR(report.nearest->distance, gap, 1e-6);
    if (gap < -1e-6) {
      ASSERT_EQ(report.contacts.size(), 1U);
      EXPECT_NEAR(report.contacts[0].depth, -gap, 1e-6);
    }
    if (gap > 1e-3) {
      const double between = (report.nearest->p2_W - report.nearest->p1_W).norm();
      EXPECT_NEAR(between, gap, 1e-6);
    }
  }
  EXPECT_GT(measured, 200);
}

/// Distance from a segment to a box round the origin, by golden-section search on a convex
/// function.
double segment_box_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& half) {
  const auto at = [&](double t) {
    const Eigen::Vector3d p = a + t * (b - a);
    return (p.cwiseAbs() - half).cwiseMax(0).norm();
  };
  double low = 0, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double t1 = high - 0.618034 * (high - low);
    const double t2 = low + 0.618034 * (high - low);
    (at(t1) < at(t2) ? high : low) = at(t1) < at(t2) ? t2 : t1;
  }
  return at(0.5 * (low + high));
}

TEST(ExactChecker, CapsuleAndBox) {
  const support::TempFolder folder;
  const World world =
      load(folder,
           slider(R"(<geom name="crate" type="box" size="0.3 0.02 0.2"/>)",
                  R"(<geom name="rod" type="capsule" size="0.03" fromto="-.1 -.4 0 .1 .4 .1"/>)"));
  ExactChecker checker(world.model, world.arm, {.margin = 0.3});
  Rng rng(74);
  int through = 0, apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p(rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6), rng.uniform(-0.4, 0.4));
    const double axis = segment_box_distance(p + Eigen::Vector3d(-0.1, -0.4, 0),
                                             p + Eigen::Vector3d(0.1, 0.4, 0.1), {0.3, 0.02, 0.2});
    const CollisionReport report = check(checker, {p.x(), p.y(), p.z()});
    if (std::abs(axis - 0.03) > 1e-5) {
      EXPECT_EQ(report.free, axis > 0.03);
    }
    if (axis < 1e-9) {
      ++through;
      ASSERT_EQ(report.contacts.size(), 1U);
      EXPECT_GT(report.contacts[0].depth, 0.03 - 1e-5);
      EXPECT_EQ(report.contacts[0].pair.geom1, "rod");
    } else if (axis < 0.329) {
      ++apart;
      ASSERT_TRUE(report.nearest.has_value());
      EXPECT_NEAR(report.nearest->distance, axis - 0.03, 1e-5);
      EXPECT_NEAR((report.nearest->p1_W - report.nearest->p2_W).norm(), std::abs(axis - 0.03),
                  1e-5);
    }
  }
  EXPECT_GT(through, 200);
  EXPECT_GT(apart, 500);
}

/// A compact box, to which MuJoCo's convex collider with a margin tells wrong distances.
TEST(ExactChecker, DistancesOfACapsuleFromABox) {
  const support::TempFolder folder;
  const World world = load(
      folder,
      slider(R"(<geom name="crate" type="box" size="0.1 0.2 0.05"/>)",
             R"(<geom name="rod" type="capsule" size="0.05" fromto="-.1 -.05 0 .1 .1 .05"/>)"));
  ExactChecker checker(world.model, world.arm);
  Rng rng(75);
  int apart = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p(rng.uniform(-0.3, 0.3), rng.uniform(-0.4, 0.4), rng.uniform(-0.2, 0.2));
    const double distance =
        segment_box_distance(p + Eigen::Vector3d(-0.1, -0.05, 0),
                             p + Eigen::Vector3d(0.1, 0.1, 0.05), {0.1, 0.2, 0.05}) -
        0.05;
    if (distance < 1e-6 || distance > 0.0999) continue;
    ++apart;
    const CollisionReport report = check(checker, {p.x(), p.y(), p.z()});
    ASSERT_TRUE(report.free && report.nearest) << distance;
    EXPECT_NEAR(report.nearest->distance, distance, 1e-7);
    EXPECT_NEAR((report.nearest->p1_W - report.nearest->p2_W).norm(), distance, 1e-7);
  }
  EXPECT_GT(apart, 200);
}

/// With a margin as wide as the world MuJoCo lists all pairs that it would ever let collide.
TEST(ExactChecker, PairRulesAreMujocos) {
  const char* const xml = R"(<mujoco><option o_margin="100"><flag override="enable"/></option>
    <worldbody><geom type="box" size=".1 .1 .1"/><geom type="sphere" size=".1" contype="2"/>
      <body name="a"><joint/><geom type="capsule" size=".1 .1"/><geom type="box" size=".1 .1 .1"/>
        <body name="b"><geom type="capsule" size=".1 .1"/>
          <body name="c"><joint/><geom type="box" size=".1 .1 .1" name="cb"/>
            <geom type="sphere" size=".1" contype="4" conaffinity="2"/>
            <body name="d"><joint axis="1 0 0"/><geom type="capsule" size=".1 .1"/>
              <body name="e"><joint/><geom type="box" size=".1 .1 .1"/></body></body></body></body></body>
      <body name="f"><geom type="capsule" size=".1 .1"/></body>
      <body name="g"><freejoint/><geom type="capsule" size=".1 .1" name="gc"/></body></worldbody>
    <contact><exclude body1="a" body2="e"/><exclude body1="g" body2="b"/>
      <pair geom1="gc" geom2="cb"/></contact></mujoco>)";
  const support::TempFolder folder;
  const auto model = Model::load(folder.write("rules.xml", xml));
  ASSERT_TRUE(model.has_value()) << model.error().what;
  const mjModel& m = *model->raw();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(&m), mj_deleteData);
  mj_forward(&m, d.get());
  std::set<std::pair<int, int>> listed, allowed;
  for (int i = 0; i < d->ncon; ++i) {
    listed.insert(std::minmax(d->contact[i].geom[0], d->contact[i].geom[1]));
  }
  for (int i = 0; i < m.ngeom; ++i) {
    for (int j = i + 1; j < m.ngeom; ++j) {
      const bool fixed =
          m.body_weldid[m.geom_bodyid[i]] == 0 && m.body_weldid[m.geom_bodyid[j]] == 0;
      if (!fixed && detail::may_collide(m, i, j)) allowed.insert({i, j});
    }
  }
  EXPECT_EQ(listed, allowed);
  EXPECT_GT(allowed.size(), 10U);
}

TEST(ExactChecker, MujocosRulesDecideWhichPairsCount) {
  const support::TempFolder folder;
  const std::string things = R"(<geom name="ghost" type="sphere" size="1" contype="0"
    conaffinity="0"/><geom name="floor" type="plane" size="5 5 1" pos="0 0 -1"/>
    <body name="box" pos="2 0 -0.95"><freejoint/><geom name="crate" type="box" size=".1 .1 .1"/>
    </body>)";
  const World world = load(folder, slider(things, R"(<geom name="ball" type="sphere" size="0.2"/>
                                     <geom type="sphere" size="0.1" pos="0 0 0.5"/>)"));
  ExactChecker checker(world.model, world.arm);
  // The crate stands in the floor, which is not the arm's fault.
  const CollisionReport at_rest = check(checker, {0, 0, 0});
  EXPECT_TRUE(at_rest.free);
  EXPECT_FALSE(at_rest.nearest.has_value());
  const CollisionReport low = check(checker, {0, 0, -0.9});
  ASSERT_EQ(low.contacts.size(), 1U);
  EXPECT_EQ(low.contacts[0].pair.geom1, "floor");
  EXPECT_EQ(low.contacts[0].pair.body1, "world");
  EXPECT_EQ(low.contacts[0].pair.geom2, "ball");
  EXPECT_NEAR(low.contacts[0].depth, 0.1, 1e-9);
  // Deepest first, and a geom without a name is called after its body.
  const CollisionReport deep = check(checker, {0, 0, -1.45});
  ASSERT_EQ(deep.contacts.size(), 2U);
  EXPECT_NEAR(deep.contacts[0].depth, 0.65, 1e-9);
  EXPECT_NEAR(deep.contacts[1].depth, 0.05, 1e-9);
  EXPECT_EQ(deep.contacts[1].pair.geom2, "z[1]");
  EXPECT_EQ(check(checker, {2, 0, -0.8}).contacts.size(), 2U);  // floor by 0, crate
}

TEST(ExactChecker, PairsWhoseDistanceNeverChangesAreNotTheNearest) {
  const support::TempFolder folder;
  const std::string xml = R"(<mujoco><compiler angle="radian"/><worldbody>
    <geom name="floor" type="plane" size="5 5 1"/>
    <body name="turret" pos="0 0 0.003">
      <joint name="j1" type="hinge" axis="0 0 1" range="-3 3"/>
      <geom name="shoulder" type="capsule" size="0.05" fromto="0 0 0.05 0.2 0 0.05"/>
      <body name="lift" pos="0 0 0.5"><joint name="j2" type="slide" axis="0 0 1" range="-1 1"/>
        <geom name="ball" type="sphere" size="0.1"/><site name="tip"/></body></body>
    </worldbody></mujoco>)";
  const World world = load(folder, xml);
  ExactChecker checker(world.model, world.arm);
  // The shoulder is 3 mm over the floor wherever it turns.
  EXPECT_FALSE(check(checker, {0.3, 0.2}).nearest.has_value());
  const CollisionReport low = check(checker, {0.3, -0.35});
  ASSERT_TRUE(low.nearest.has_value());
  EXPECT_EQ(low.nearest->pair.geom2, "ball");
  // Where it does overlap, that is by design; to an arm that knows of none a contact as any other.
  const std::string sunk = std::string(xml).replace(xml.find("0.003"), 5, "-0.01");
  World below = load(folder, sunk);
  ExactChecker lenient(below.model, below.arm);
  EXPECT_TRUE(check(lenient, {0.3, 0.2}).free);
  below.arm.overlapping.clear();
  ExactChecker strict(below.model, below.arm);
  EXPECT_FALSE(check(strict, {0.3, 0.2}).free);
}

TEST(ExactChecker, TouchingWithinTheAllowedDepthIsFree) {
  const support::TempFolder folder;
  const World world = load(
      folder, slider(R"(<geom type="sphere" size="0.3"/>)", R"(<geom type="sphere" size="0.2"/>)"));
  ExactChecker checker(world.model, world.arm, {.margin = 0, .allow_depth = 0.01});
  const CollisionReport light = check(checker, {0.495, 0, 0});
  EXPECT_TRUE(light.free);
  EXPECT_EQ(light.contacts.size(), 1U);
  EXPECT_FALSE(light.nearest.has_value());
  EXPECT_FALSE(check(checker, {0.485, 0, 0}).free);
}

TEST(ExactChecker, WorksWhereTheFileSwitchesContactsOff) {
  const support::TempFolder folder;
  std::string xml =
      slider(R"(<geom type="sphere" size="0.3"/>)", R"(<geom type="sphere" size="0.2"/>)");
  const std::string head = R"(<compiler angle="radian"/>)";
  xml.insert(xml.find(head) + head.size(), R"(<option><flag contact="disable"/></option>)");
  const World world = load(folder, xml);
  ExactChecker checker(world.model, world.arm);
  EXPECT_FALSE(check(checker, {0.1, 0, 0}).free);
  EXPECT_TRUE(check(checker, {0.6, 0, 0}).free);
}

TEST(ExactChecker, BadInputIsAnError) {
  const support::TempFolder folder;
  const World world = load(folder, slider("", R"(<geom type="sphere" size="0.2"/>)"));
  ExactChecker checker(world.model, world.arm);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& q :
       {std::vector<double>{0, nan, 0}, {inf, 0, 0}, {0, 0}, {0, 0, 0, 0}, {}}) {
    const auto report = checker.check(q);
    ASSERT_FALSE(report.has_value());
    EXPECT_EQ(report.error().code, Errc::bad_input);
    EXPECT_NE(report.error().what.find('3'), std::string::npos);
    EXPECT_FALSE(checker.is_free(q));
  }
  Arm stranger = world.arm;
  stranger.joints[0].qpos = 77;
  ExactChecker wrong(world.model, stranger);
  EXPECT_FALSE(wrong.check(std::vector<double>{0, 0, 0}).has_value());
}

TEST(ExactChecker, OptionsThatAreNotSoundAreRefusedAtOnce) {
  const support::TempFolder folder;
  const World world = load(folder, slider("", R"(<geom type="sphere" size="0.2"/>)"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<ExactOptions> bad{
      {.margin = -1e-9},   {.margin = nan},      {.margin = inf},
      {.allow_depth = -1}, {.allow_depth = nan}, {.rules = {.allowed = {{"nobody", "nothing"}}}}};
  for (const ExactOptions& options : bad) {
    const auto made = ExactChecker::create(world.model, world.arm, options);
    ASSERT_FALSE(made.has_value());
    EXPECT_EQ(made.error().code, Errc::bad_input);
    EXPECT_FALSE(made.error().what.empty());
  }
  Arm stranger = world.arm;
  stranger.joints[0].qpos = 77;
  EXPECT_FALSE(ExactChecker::create(world.model, stranger, {}).has_value());
  auto made = ExactChecker::create(world.model, world.arm, {.margin = 0.3});
  ASSERT_TRUE(made.has_value());
  ExactChecker plain(world.model, world.arm, {.margin = 0.3});
  const std::vector<double> q{0.1, 0.2, -0.3};
  EXPECT_EQ(made->check(q)->free, plain.check(q)->free);
}

TEST(ExactChecker, CopiesAreIndependentAndAgree) {
  const support::TempFolder folder;
  const World world = load(folder, slider(R"(<geom type="box" size="0.3 0.2 0.1"/>)",
                                          R"(<geom type="cylinder" size="0.2 0.3"/>)"));
  ExactChecker checker(world.model, world.arm);
  ExactChecker copy = checker;
  ExactChecker assigned(world.model, world.arm, {.margin = 0});
  assigned = copy;
  Rng rng(73);
  for (int i = 0; i < 200; ++i) {
    const std::vector<double> q{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
    const auto a = checker.check(q);
    (void)copy.is_free(std::vector<double>{0, 0, 0});
    const auto b = copy.check(q);
    const auto c = assigned.check(q);
    ASSERT_TRUE(a && b && c);
    EXPECT_EQ(a->free, b->free);
    ASSERT_EQ(a->nearest.has_value(), b->nearest.has_value());
    ASSERT_EQ(a->nearest.has_value(), c->nearest.has_value());
    if (!a->nearest) continue;
    EXPECT_EQ(a->nearest->distance, b->nearest->distance);
    EXPECT_EQ(a->nearest->distance, c->nearest->distance);
  }
}

TEST(ExactChecker, PredicateKeepsIkOutOfTheWall) {
  const support::TempFolder folder;
  // A planar arm of two links reaches a point with the elbow on either side; a wall stands at one.
  const World world = load(folder, R"(<mujoco><compiler angle="radian"/><worldbody>
    <geom name="wall" type="box" size="0.5 0.02 1" pos="0.4 0.3 0"/>
    <body name="upper"><joint name="j1" axis="0 0 1" range="-3 3"/>
      <geom type="capsule" size="0.02" fromto="0 0 0 0.5 0 0"/>
      <body name="lower" pos="0.5 0 0"><joint name="j2" axis="0 0 1" range="-3 3"/>
        <geom type="capsule" size="0.02" fromto="0 0 0 0.3 0 0"/>
        <body name="hand" pos="0.5 0 0"><joint name="j3" axis="0 0 1" range="-3 3"/>
          <geom type="sphere" size="0.02"/><site name="tip"/>
    </body></body></body></worldbody></mujoco>)");
  ExactChecker checker(world.model, world.arm);
  const std::vector<double> blocked{1.0, -2.0, 0.5};  // elbow at (0.27, 0.42)
  EXPECT_FALSE(checker.is_free(blocked));
  const Pose X_goal = fk(world.arm, blocked);
  IkOptions options;
  ASSERT_TRUE(IkSolver(world.arm, options).solve(X_goal, blocked).has_value());
  options.valid = checker.predicate();
  const auto answer = IkSolver(world.arm, options).solve(X_goal, blocked);
  ASSERT_TRUE(answer.has_value());
  EXPECT_GT(answer->q[1], 0);
  EXPECT_TRUE(checker.is_free(as_span(answer->q)));
}

TEST(ExactChecker, DescribesWhatItFound) {
  const support::TempFolder folder;
  const World world = load(folder, slider(R"(<geom name="rock" type="sphere" size="0.3"/>)",
                                          R"(<geom name="ball" type="sphere" size="0.2"/>)"));
  ExactChecker checker(world.model, world.arm);
  set_language(Language::english);
  EXPECT_EQ(describe(check(checker, {0.47, 0, 0})),
            "collision: \"rock\" (body world) overlaps \"ball\" (body z) by 0.0300 m");
  EXPECT_EQ(describe(check(checker, {0.52, 0, 0})),
            "free of collisions: \"rock\" and \"ball\" are nearest, 0.0200 m apart");
  EXPECT_EQ(describe(check(checker, {3, 0, 0})), "free of collisions");
}

}  // namespace
}  // namespace mjarm
