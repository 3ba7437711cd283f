#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "mjarm/collision/exact.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/core/finite.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/find_arm.hpp"

/// The exact checker on the shipped models, against MuJoCo called directly.
namespace mjarm {
namespace {

struct Shipped {
  explicit Shipped(const char* name)
      : model(Model::load(find_model_file(name).value()).value()),
        arm(find_arm(model).value()),
        d(mj_makeData(model.raw()), mj_deleteData) {
    const mjModel& m = *model.raw();
    const int home = mj_name2id(&m, mjOBJ_KEY, "home");
    if (home >= 0) mj_resetDataKeyframe(&m, d.get(), home);
    for (int b = 1; b < m.nbody; ++b) {
      const int first = m.jnt_bodyid[joint_of(arm.joints.front())];
      int above = b;
      while (above > 0 && above != first) above = m.body_parentid[above];
      if (above == first) moving.insert(b);
    }
  }

  int joint_of(const ArmJoint& joint) const {
    return mj_name2id(model.raw(), mjOBJ_JOINT, joint.name.c_str());
  }
  void place(const std::vector<double>& q) const {
    for (std::size_t i = 0; i < q.size(); ++i) d->qpos[arm.joints[i].qpos] = q[i];
    mj_forward(model.raw(), d.get());
  }
  bool moves(int geom) const { return moving.count(model.raw()->geom_bodyid[geom]) > 0; }
  std::vector<double> random_q(Rng& rng) const {
    std::vector<double> q;
    for (int i = 0; i < arm.dof(); ++i) {
      q.push_back(rng.uniform(arm.limits.lower[i], arm.limits.upper[i]));
    }
    return q;
  }

  Model model;
  Arm arm;
  std::unique_ptr<mjData, void (*)(mjData*)> d;
  std::set<int> moving;
};

/// Every overlap that mj_forward sees is seen, and no other, but for capsules in boxes, of which
/// MuJoCo misses some.
void compare_with_forward(const Shipped& robot, std::uint64_t seed) {
  const mjModel& m = *robot.model.raw();
  ExactChecker checker(robot.model, robot.arm, {.margin = 0});
  Rng rng(seed);
  int touching = 0;
  for (int round = 0; round < 1000; ++round) {
    const std::vector<double> q = robot.random_q(rng);
    robot.place(q);
    std::size_t expected = 0;
    double deepest = 0;
    std::set<std::pair<int, int>> pairs;
    for (int i = 0; i < robot.d->ncon; ++i) {
      const mjContact& contact = robot.d->contact[i];
      if (!robot.moves(contact.geom[0]) && !robot.moves(contact.geom[1])) continue;
      if (contact.dist >= 0 || detail::is_measured_here(m, contact.geom[0], contact.geom[1]))
        continue;
      expected += pairs.insert({contact.geom[0], contact.geom[1]}).second ? 1 : 0;
      deepest = std::max(deepest, -contact.dist);
    }
    const auto report = checker.check(q);
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->free, report->contacts.empty());
    EXPECT_EQ(report->free, checker.is_free(q));
    EXPECT_GE(report->contacts.size(), expected);
    if (expected > 0) {
      ++touching;
      EXPECT_FALSE(report->free);
      EXPECT_GE(report->contacts.front().depth, deepest - 1e-12);
    }
  }
  EXPECT_GT(touching, 50);
  EXPECT_LT(touching, 1000);
}

/// A checker that measures finds the same overlaps as one that does not, also where things only
/// just touch: between a free posture and one that is not, halved until they are the same.
void expect_same_overlaps(const Shipped& robot, std::uint64_t seed) {
  ExactChecker plain(robot.model, robot.arm, {.margin = 0}), measuring(robot.model, robot.arm);
  Rng rng(seed);
  const std::vector<double> home(robot.arm.home.begin(), robot.arm.home.end());
  int touching = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<double> free = home, hit = robot.random_q(rng), at = hit;
    if (plain.is_free(hit)) continue;
    ++touching;
    for (int k = 0; k < 50; ++k) {
      const auto a = plain.check(at), b = measuring.check(at);
      ASSERT_TRUE(a && b);
      EXPECT_EQ(a->free, b->free);
      EXPECT_EQ(a->free, plain.is_free(at));
      EXPECT_EQ(b->free, measuring.is_free(at));
      ASSERT_EQ(a->contacts.size(), b->contacts.size());
      for (std::size_t i = 0; i < a->contacts.size(); ++i) {
        EXPECT_EQ(a->contacts[i].depth, b->contacts[i].depth);
      }
      (a->free ? free : hit) = at;
      for (std::size_t i = 0; i < at.size(); ++i) at[i] = 0.5 * (free[i] + hit[i]);
    }
  }
  EXPECT_GT(touching, 10);
}

/// What a checker remembers of the last look: its verdicts are those of one that never looked
/// before, and its bounds hold, along ways that come near to things and into them.
void expect_memory_holds(const Shipped& robot, std::uint64_t seed) {
  const ExactOptions told{.skip_neighbours = true};
  ExactChecker walking(robot.model, robot.arm), fresh(robot.model, robot.arm, {.margin = 0});
  ExactChecker bounded(robot.model, robot.arm, told), looking(robot.model, robot.arm, told);
  Rng rng(seed);
  int touching = 0, known = 0, tight = 0;
  for (int way = 0; way < 60; ++way) {
    const std::vector<double> from = robot.random_q(rng), to = robot.random_q(rng);
    const double step = rng.uniform(5e-4, 5e-3);
    for (int k = 0; k < 200; ++k) {
      std::vector<double> q = from;
      for (std::size_t i = 0; i < q.size(); ++i) q[i] += k * step * (to[i] - from[i]);
      const bool free = walking.is_free(q);
      ASSERT_EQ(free, fresh.is_free(q)) << way << ", " << k;
      touching += free ? 0 : 1;
      const double bound = bounded.least_distance(q);
      const auto report = looking.check(q);
      ASSERT_TRUE(report);
      double distance = report->nearest ? report->nearest->distance : kInfinity;
      if (!report->free) distance = std::min(distance, -report->contacts.front().depth);
      ASSERT_LE(bound, distance) << way << ", " << k;
      known += bound > 0 ? 1 : 0;
      tight += bound > distance - 0.01 ? 1 : 0;
      if (!(bound > 0)) {
        ASSERT_TRUE(bounded.check(q));
      }
    }
  }
  EXPECT_GT(touching, 200);
  EXPECT_GT(known, 500);
  EXPECT_GT(tight, 100);
}

constexpr double kMargin = 0.15;  // [m]

/// Distances of all pairs that may collide, up to the margin, where the robot was placed.
std::map<std::pair<int, int>, double> all_distances(const Shipped& robot) {
  const mjModel& m = *robot.model.raw();
  std::map<std::pair<int, int>, double> out;
  for (int i = 0; i < m.ngeom; ++i) {
    for (int j = 0; j < m.ngeom; ++j) {
      if (i == j || m.geom_type[i] > m.geom_type[j]) continue;
      if (!robot.moves(i) && !robot.moves(j)) continue;
      if (!detail::may_collide(m, i, j)) continue;
      if (detail::is_measured_here(m, i, j)) {
        const auto gap = detail::gap_measured_here(m, robot.d.get(), {i, j}, kMargin);
        out[{i, j}] = gap ? gap->distance : kMargin;
      } else {
        out[{i, j}] = mj_geomDistance(&m, robot.d.get(), i, j, kMargin, nullptr);
      }
    }
  }
  return out;
}

/// Pairs that are equally far apart in each of 50 postures.
std::set<std::pair<int, int>> constant_pairs(const Shipped& robot, Rng& rng) {
  std::map<std::pair<int, int>, std::pair<double, double>> ranges;
  for (int round = 0; round < 50; ++round) {
    robot.place(robot.random_q(rng));
    for (const auto& [pair, distance] : all_distances(robot)) {
      auto& [least, max] = ranges.try_emplace(pair, distance, distance).first->second;
      least = std::min(least, distance);
      max = std::max(max, distance);
    }
  }
  std::set<std::pair<int, int>> out;
  for (const auto& [pair, range] : ranges) {
    if (range.second < kMargin && range.second - range.first < 1e-6) out.insert(pair);
  }
  return out;
}

/// The nearest pair, against the distances of all pairs that may collide.
void compare_with_all_pairs(const Shipped& robot, std::uint64_t seed) {
  ExactChecker checker(robot.model, robot.arm, {.margin = kMargin});
  Rng rng(seed);
  const std::set<std::pair<int, int>> constant = constant_pairs(robot, rng);
  int apart = 0;
  for (int round = 0; round < 200; ++round) {
    const std::vector<double> q = robot.random_q(rng);
    robot.place(q);
    double nearest = kMargin;
    for (const auto& [pair, distance] : all_distances(robot)) {
      if (!constant.contains(pair)) nearest = std::min(nearest, distance);
    }
    const auto report = checker.check(q);
    ASSERT_TRUE(report.has_value());
    ASSERT_EQ(report->nearest.has_value(), nearest < kMargin);
    if (!report->nearest) continue;
    EXPECT_NEAR(report->nearest->distance, nearest, 1e-9);
    apart += nearest > 0 ? 1 : 0;
  }
  EXPECT_GT(apart, 10);
}

TEST(ExactCheckerModels, AgreesWithForwardOnTheUr5e) { compare_with_forward(Shipped("ur5e"), 81); }
TEST(ExactCheckerModels, AgreesWithForwardOnThePanda) {
  compare_with_forward(Shipped("panda"), 82);
}
TEST(ExactCheckerModels, NearestIsNearestOnTheUr5e) { compare_with_all_pairs(Shipped("ur5e"), 83); }
TEST(ExactCheckerModels, NearestIsNearestOnThePanda) {
  compare_with_all_pairs(Shipped("panda"), 84);
}

TEST(ExactCheckerModels, MeasuringChangesNoVerdict) {
  expect_same_overlaps(Shipped("ur5e"), 85);
  expect_same_overlaps(Shipped("panda"), 86);
}

TEST(ExactCheckerModels, WhatWasSeenBeforeChangesNoVerdict) {
  expect_memory_holds(Shipped("ur5e"), 87);
  expect_memory_holds(Shipped("panda"), 88);
}

TEST(ExactCheckerModels, HomeIsFree) {
  for (const char* name : {"ur5e", "panda"}) {
    const Shipped robot(name);
    ExactChecker checker(robot.model, robot.arm);
    const auto report = checker.check(as_span(robot.arm.home));
    ASSERT_TRUE(report.has_value());
    EXPECT_TRUE(report->free) << name << ": " << describe(*report);
  }
}

TEST(ExactCheckerModels, Ur5eStartBelowTheFloorIsReported) {
  const Shipped robot("ur5e");
  ExactChecker checker(robot.model, robot.arm);
  const auto report = checker.check(std::vector<double>{0, 0, 2.65, -1.3, 1.55, 0});
  ASSERT_TRUE(report.has_value());
  EXPECT_FALSE(report->free);
  const bool floor_named = std::any_of(
      report->contacts.begin(), report->contacts.end(), [](const ContactPoint& contact) {
        return contact.pair.geom1 == "floor" || contact.pair.geom2 == "floor";
      });
  EXPECT_TRUE(floor_named) << describe(*report);
}

TEST(ExactCheckerModels, PandaHandInTheFloorIsNamed) {
  const Shipped robot("panda");
  ExactChecker checker(robot.model, robot.arm);
  // Stretched forwards and down, the hand first.
  const auto report = checker.check(std::vector<double>{0, 1.6, 0, -0.6, 0, 2.2, 0.785});
  ASSERT_TRUE(report.has_value());
  ASSERT_FALSE(report->free);
  const ContactPoint& worst = report->contacts.front();
  EXPECT_EQ(worst.pair.geom1, "floor");
  EXPECT_NEAR(worst.normal_W.z(), 1, 1e-12);
  EXPECT_TRUE(worst.pair.body2 == "hand" || worst.pair.body2.find("finger") != std::string::npos)
      << describe(*report);
}

/// Joints of the arm between two of its bodies, or between the world and one of them.
int joints_between(const Shipped& robot, int body1, int body2) {
  const mjModel& m = *robot.model.raw();
  const auto count = [&](int body) {
    int joints = 0;
    for (; body > 0; body = m.body_parentid[body]) {
      joints += static_cast<int>(std::ranges::count_if(robot.arm.joints, [&](const auto& joint) {
        return m.jnt_bodyid[robot.joint_of(joint)] == body;
      }));
    }
    return joints;
  };
  return std::abs(count(body1) - count(body2));
}

/// Neighbouring links are as near to each other in nearly every posture, and would hide all else.
TEST(ExactChecker, NeighboursAreLeftOutUnlessTheyCloseIn) {
  for (const char* name : {"ur5e", "panda"}) {
    const Shipped robot(name);
    const mjModel& m = *robot.model.raw();
    ExactChecker checker(robot.model, robot.arm, {.margin = kMargin, .skip_neighbours = true});
    Rng rng(3);
    std::set<std::pair<int, int>> meet;  // were seen to touch
    for (int k = 0; k < 300; ++k) {
      robot.place(robot.random_q(rng));
      for (const auto& [pair, distance] : all_distances(robot)) {
        if (distance <= 0) meet.insert(pair);
      }
    }
    int told = 0;
    for (int k = 0; k < 200; ++k) {
      const std::vector<double> q = robot.random_q(rng);
      const CollisionReport report = checker.check(q).value();
      if (!report.free) continue;
      robot.place(q);
      double nearest = kMargin;
      for (const auto& [pair, distance] : all_distances(robot)) {
        const auto& [a, b] = pair;
        const bool own = robot.moves(a) && robot.moves(b);
        const bool near = own && joints_between(robot, m.geom_bodyid[a], m.geom_bodyid[b]) <= 3;
        if (meet.contains(pair) && (!near || distance < 0.02))
          nearest = std::min(nearest, distance);
      }
      const double here = report.nearest ? report.nearest->distance : kMargin;
      EXPECT_LE(here, nearest + 1e-9);
      if (!report.nearest || here < 0.02) continue;
      const GeomPair& pair = report.nearest->pair;
      const int body1 = mj_name2id(&m, mjOBJ_BODY, pair.body1.c_str());
      const int body2 = mj_name2id(&m, mjOBJ_BODY, pair.body2.c_str());
      const bool own = robot.moving.contains(body1) && robot.moving.contains(body2);
      EXPECT_TRUE(!own || joints_between(robot, body1, body2) > 3) << pair.geom1 << pair.geom2;
      ++told;
    }
    EXPECT_GT(told, 5) << name;
  }
}

/// The elbow near the floor, though some links of the wrist are nearer to each other, as always.
TEST(ExactChecker, AnElbowNearTheFloorIsSeen) {
  const Shipped robot("ur5e");
  ExactChecker checker(robot.model, robot.arm, {.skip_neighbours = true});
  const std::vector<double> q{0, -3.2, 1.5, -0.5, 1.57, 0};
  const CollisionReport report = checker.check(q).value();
  ASSERT_TRUE(report.free) << describe(report);
  ASSERT_TRUE(report.nearest);
  EXPECT_EQ(report.nearest->pair.geom1, "floor") << describe(report);
  EXPECT_LT(report.nearest->distance, 0.1);
}

/// MuJoCo's collider has the flange, upright to the last bit 20 mm above the floor, 19 mm inside
/// it.
TEST(ExactChecker, AnUprightCylinderAboveTheFloorIsFree) {
  const std::vector<double> q{-2.6775374155879006, -0.9478876410168369, 2.378939050985549,
                              -3.001847736763609,  -1.5707963267948966, -1.106741088793004};
  const std::filesystem::path file = find_model_file("ur5e").value();
  for (const bool looks : {true, false}) {
    const Model model = Model::load(file, {.looks = looks}).value();
    ExactChecker checker(model, find_arm(model).value());
    const CollisionReport report = checker.check(q).value();
    EXPECT_TRUE(report.free) << describe(report);
    ASSERT_TRUE(report.nearest.has_value());
    EXPECT_NEAR(report.nearest->distance, 0.02, 2e-4);
  }
}

}  // namespace
}  // namespace mjarm
