// Proofs that the tool keeps within regions that hang on a mechanism.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/planning/hung_region_test.hpp"
#include "mjarm/planning/path_keeper_internal.hpp"

namespace mjarm {
namespace {

using detail::PathKeeper;
using std::numbers::pi;
using testing::moved_region;

struct ArmEdge {
  Arm arm;
  JointVec q0 = {}, q1 = {};

  [[nodiscard]] Pose tool(double t) const {
    const JointVec q = q0 + t * (q1 - q0);
    return fk(arm, as_span(q));
  }
};

ArmEdge random_edge(Rng& rng) {
  ArmEdge out{.arm = testing::random_arm(2 + static_cast<int>(rng.below(6)), rng)};
  out.q0.resize(out.arm.dof());
  out.q1.resize(out.arm.dof());
  const double way = rng.uniform(0.05, 0.6);
  for (int i = 0; i < out.arm.dof(); ++i) {
    out.q0[i] = rng.uniform(-2, 2);
    out.q1[i] = out.q0[i] + rng.uniform(-way, way);
  }
  return out;
}

/// On any axis, often one of R's, near to where the tool begins.
Mechanism random_mechanism(const ArmEdge& edge, const Pose& X_WR, Rng& rng) {
  const auto vector = [&] { return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()); };
  Mechanism out{.type = rng.uniform() < 0.75 ? JointType::hinge : JointType::slide};
  out.axis_W = rng.uniform() < 0.5 ? vector().normalized()
                                   : Eigen::Vector3d(X_WR.R.col(static_cast<int>(rng.below(3))));
  out.p_W = edge.tool(0).p + 0.4 * vector();
  out.min = rng.uniform(-0.2, 0.1);
  out.max = out.min + rng.uniform(0, 0.5);
  if (out.type == JointType::hinge && rng.uniform() < 0.2) {
    out.min = -pi;
    out.max = pi;
  }
  return out;
}

/// Bounds about what the tool does, seen from a mechanism that moves evenly between two values: of
/// all kinds, some of which the tool breaks.
TaskRegion bounds_along(const ArmEdge& edge, Rng& rng) {
  const auto vector = [&] { return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()); };
  TaskRegion out{.X_FT = {0.1 * vector(), rotation_exp(vector())}};
  out.X_WR.R = rotation_exp(vector());
  // Turns about z of R at the base count for less, unless the mechanism tilts R.
  const ArmJoint& first = edge.arm.joints.front();
  if (rng.uniform() < 0.5) {
    out.X_WR.R = rotation_between(Eigen::Vector3d::UnitZ(), first.X_PJ.R * first.axis);
  }
  out.mechanism = random_mechanism(edge, out.X_WR, rng);
  const double from = rng.uniform(out.mechanism->min, out.mechanism->max),
               to = rng.uniform(out.mechanism->min, out.mechanism->max);
  std::array<Eigen::Vector3d, 2> place, turn;
  for (int i = 0; i <= 20; ++i) {
    const TaskRegion there = moved_region(out, from + i / 20.0 * (to - from));
    const Pose X_RF = there.X_WR.inverse() * edge.tool(i / 20.0) * out.X_FT.inverse();
    const Eigen::Vector3d rpy = to_euler(X_RF.R);
    place = {i == 0 ? X_RF.p : place[0].cwiseMin(X_RF.p),
             i == 0 ? X_RF.p : place[1].cwiseMax(X_RF.p)};
    turn = {i == 0 ? rpy : turn[0].cwiseMin(rpy), i == 0 ? rpy : turn[1].cwiseMax(rpy)};
  }
  for (int k = 0; k < 3; ++k) {
    const double farthest = k == 1 ? kFreePitch : kFreeTurn;
    const bool calm = turn[0][1] > -1.2 && turn[1][1] < 1.2 && turn[1][k] - turn[0][k] < 2.5;
    const bool any_place = rng.uniform() < 0.5, any_turn = !calm || rng.uniform() < 0.5;
    const auto past = [&] { return rng.uniform() < 0.85 ? rng.uniform(2e-3, 0.1) : -0.02; };
    out.place_min[k] = any_place ? -kFreePlace : place[0][k] - past();
    out.place_max[k] =
        any_place ? kFreePlace : std::max(place[1][k] + past(), out.place_min[k] + 2e-3);
    out.turn_min[k] = any_turn ? -farthest : std::max(turn[0][k] - past(), -farthest);
    out.turn_max[k] =
        any_turn ? farthest : std::clamp(turn[1][k] + past(), out.turn_min[k] + 2e-3, farthest);
  }
  return out;
}

TEST(MechanismProof, EdgesThatAreKeptAreSoAtEveryPlaceAndThoseThatLeaveAreRefused) {
  Rng rng(21);
  int kept = 0, left = 0, refused = 0;
  const int cases = testing::rounds(200, 20'000);
  for (int k = 0; k < cases; ++k) {
    const ArmEdge edge = random_edge(rng);
    const TaskRegion region = bounds_along(edge, rng);
    if (!can_be_kept(region)) continue;
    const auto keeper = PathKeeper::create({.within = region}, edge.arm);
    const auto look = keeper->look(as_span(edge.q0), as_span(edge.q1));
    RegionRoom least;
    double most = 9;  // at the worst of all places, with the best value of the mechanism there
    for (int i = 0; i <= 40; ++i) {
      const RegionRoom room = room_in(region, edge.tool(i / 40.0));
      least = {std::min(least.place, room.place), std::min(least.turn, room.turn)};
      if (i % 8 == 0) most = std::min(most, testing::most_room(region, edge.tool(i / 40.0), 100));
    }
    if (look.kept) {
      ++kept;
      EXPECT_TRUE(least.within(1e-7)) << k << " " << least.place << " " << least.turn;
      EXPECT_GE(most, -1e-6) << k;
      EXPECT_GE(most, std::min({look.room.place, look.room.turn, 9.0}) - 1e-6) << k;
    } else {
      ++refused;
    }
    if (!least.within(1e-6)) {
      ++left;
      EXPECT_FALSE(look.kept) << k;
    }
  }
  EXPECT_GT(kept, cases / 10);
  EXPECT_GT(left, cases / 10);
  // What does not leave is mostly proved.
  EXPECT_LT(refused - left, kept / 3) << refused << " " << left << " " << kept;
}

/// Three slides, and a hinge about the upright.
Arm arm_on_slides() {
  const auto slide = [](const Eigen::Vector3d& axis) {
    return testing::JointRow{{0, 0, 0}, {0, 0, 0}, axis, -1, 1, JointType::slide};
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  return testing::make_arm("slides",
                           {slide(x), slide(y), slide(z), {{0, 0, 0}, {0, 0, 0}, z, -2, 2}}, {});
}

/// A hand on slides that turns about an axis as the door does, along a line, so that all that
/// bulges is what the turning door adds. Bounds are past the ends of what it does by up to 1.6
/// times as much as it goes past them on its way.
TaskRegion bounds_past_ends(const ArmEdge& edge, Rng& rng) {
  TaskRegion out{.X_WR = {{0.1, -0.1, 0.05}, rotation_exp({0, 0, rng.normal()})}};
  out.mechanism =
      Mechanism{.p_W = {0.2 * rng.normal(), 0.2 * rng.normal(), 0}, .min = -2, .max = 2};
  Eigen::Vector3d ends_min, ends_max, min, max;
  for (const int i : {0, 20, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19}) {
    const double t = i / 20.0, angle = (1 - t) * edge.q0[3] + t * edge.q1[3];
    const Eigen::Vector3d p = moved_region(out, angle).X_WR.inverse() * edge.tool(t).p;
    if (i == 0) ends_min = ends_max = p;
    if (i == 0 || i == 20) {
      min = ends_min = ends_min.cwiseMin(p);
      max = ends_max = ends_max.cwiseMax(p);
    }
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  for (int k = 0; k < 3; ++k) {
    out.place_min[k] = ends_min[k] - rng.uniform(0, 1.2) * (ends_min[k] - min[k]) - 2e-3;
    out.place_max[k] = ends_max[k] + rng.uniform(0, 1.2) * (max[k] - ends_max[k]) + 2e-3;
  }
  // The hand does not turn in the handle, so that it tells where the door stands.
  out.turn_min = {-0.1, -0.1, -1.1e-3};
  out.turn_max = -out.turn_min;
  out.X_FT.R = out.X_WR.R.transpose();
  return out;
}

TEST(MechanismProof, WhatTheTurnOfADoorAddsIsCounted) {
  Rng rng(24);
  int kept = 0, left = 0;
  for (int k = 0; k < 600; ++k) {
    ArmEdge edge{.arm = arm_on_slides()};
    edge.q0.resize(4);
    edge.q1.resize(4);
    for (int i = 0; i < 4; ++i) {
      edge.q0[i] = rng.uniform(-0.4, 0.4);
      edge.q1[i] = edge.q0[i] + rng.uniform(-0.5, 0.5);
    }
    const TaskRegion region = bounds_past_ends(edge, rng);
    const auto look =
        PathKeeper::create({.within = region}, edge.arm)->look(as_span(edge.q0), as_span(edge.q1));
    double least = 9;
    for (int i = 0; i <= 100; ++i)
      least = std::min(least, room_in(region, edge.tool(i / 100.0)).place);
    if (least < -1e-7) {
      ++left;
      EXPECT_FALSE(look.kept) << k << " " << least;
    } else if (look.kept) {
      ++kept;
      EXPECT_LE(look.room.place, least + 1e-9);
    }
  }
  EXPECT_GT(kept, 50);
  EXPECT_GT(left, 40);
}

TEST(MechanismProof, ThatBoundsTurnWithADoorIsCounted) {
  Rng rng(25);
  int kept = 0, left = 0;
  for (int k = 0; k < 200; ++k) {
    // A hand that does not turn goes past a door on a level hinge. Seen from there its pitch is
    // largest on the way, not in the middle of it, and there by a bit more than is allowed or not.
    ArmEdge edge{.arm = arm_on_slides(), .q0 = JointVec::Zero(4), .q1 = JointVec::Zero(4)};
    const double from = rng.uniform(0.15, 0.25), to = rng.uniform(0.4, 0.5);
    edge.q0[0] = 0.5 * std::cos(from);
    edge.q0[2] = 0.5 * std::sin(from);
    edge.q1[0] = 0.5 * std::cos(to);
    edge.q1[2] = -0.5 * std::sin(to);
    const double turned = rng.uniform(0.4, 0.8);
    const Eigen::Vector3d x_F(0, std::sin(turned), -std::cos(turned));
    TaskRegion region = region_about({}, {kFreePlace, kFreePlace, 0.03}, pi, kFreeTurn);
    region.X_FT.R = rotation_between(Eigen::Vector3d::UnitX(), x_F).transpose();
    region.mechanism = Mechanism{.axis_W = Eigen::Vector3d::UnitY(), .min = -1, .max = 1};
    region.turn_max[1] = std::asin(std::cos(turned) * (1 - rng.uniform(-0.005, 0.01)));
    const auto look =
        PathKeeper::create({.within = region}, edge.arm)->look(as_span(edge.q0), as_span(edge.q1));
    double least = 9;
    for (int i = 0; i <= 200; ++i) {
      least = std::min(least, room_in(region, edge.tool(i / 200.0)).turn);
    }
    left += least < -1e-6 ? 1 : 0;
    kept += look.kept ? 1 : 0;
    EXPECT_FALSE(least < -1e-6 && look.kept) << k << " " << least;
  }
  EXPECT_GT(kept, 10);
  EXPECT_GT(left, 40);
}

TEST(MechanismProof, TheMechanismMovesEvenlyAndNeverJumps) {
  // A door on the same axis as the base of the arm.
  const Arm arm = testing::ur5e();
  const JointVec q0 = arm.home;
  const Pose held = fk(arm, as_span(q0));
  TaskRegion door = region_about(held, Eigen::Vector3d::Constant(0.02), 0.05, 0.05);
  door.mechanism = Mechanism{.min = 0, .max = 0.6};
  const auto keeper = PathKeeper::create({.within = door}, arm);
  JointVec open = q0, farther = q0;
  open[0] += 0.6;
  farther[0] += 0.7;
  EXPECT_TRUE(keeper->look(as_span(q0), as_span(open)).kept);
  const auto edge = keeper->look(as_span(q0), as_span(farther));
  EXPECT_FALSE(edge.kept);
  EXPECT_NEAR(edge.t, 6.0 / 7, 0.1);
  // A whole turn ends where it began, but passes both stops.
  door.mechanism->min = -0.6;
  const auto wide = PathKeeper::create({.within = door}, arm);
  JointVec around = q0;
  around[0] += 2 * pi;
  EXPECT_TRUE(wide->keeps(as_span(q0)));
  EXPECT_TRUE(wide->keeps(as_span(around)));
  EXPECT_FALSE(wide->look(as_span(q0), as_span(around)).kept);
  // A hinge without stops goes along, over the seam of its angles.
  door.mechanism->min = -pi;
  door.mechanism->max = pi;
  const auto free = PathKeeper::create({.within = door}, arm);
  EXPECT_TRUE(free->look(as_span(q0), as_span(around)).kept);
}

TEST(MechanismProof, OneThatStandsStillIsProvedAsOneRegion) {
  Rng rng(22);
  int kept = 0;
  for (int k = 0; k < 200; ++k) {
    const ArmEdge edge = random_edge(rng);
    TaskRegion region = bounds_along(edge, rng);
    region.mechanism->max = region.mechanism->min;
    if (!can_be_kept(region)) continue;
    const TaskRegion alone = moved_region(region, region.mechanism->min);
    const auto hung = PathKeeper::create({.within = region}, edge.arm),
               still = PathKeeper::create({.within = alone}, edge.arm);
    const auto a = hung->look(as_span(edge.q0), as_span(edge.q1)),
               b = still->look(as_span(edge.q0), as_span(edge.q1));
    EXPECT_EQ(a.kept, b.kept);
    if (!a.kept) continue;
    ++kept;
    EXPECT_NEAR(std::min(a.room.place, 9.0), std::min(b.room.place, 9.0), 1e-3);
    EXPECT_NEAR(std::min(a.room.turn, 9.0), std::min(b.room.turn, 9.0), 1e-3);
  }
  EXPECT_GT(kept, 10);
}

TEST(MechanismProof, PutsBackWithinAtSomeValueOfTheMechanism) {
  const Arm arm = testing::ur5e();
  Rng rng(23);
  const Pose down{{0.3, -0.4, 0.3}, from_euler({pi, 0, 0})};
  TaskRegion door = region_about(down, Eigen::Vector3d::Constant(0.01), 0.05, 0.7);
  door.mechanism = Mechanism{.p_W = {0.55, -0.4, 0}, .min = -1.2, .max = 0.3};
  TaskRegion drawer = door;
  drawer.mechanism = Mechanism{
      .type = JointType::slide, .axis_W = Eigen::Vector3d(1, 0, 0.2).normalized(), .max = 0.2};
  for (const TaskRegion& region : {door, drawer}) {
    const auto keeper = PathKeeper::create({.within = region}, arm);
    int done = 0;
    double least = 9, most = -9;
    for (int k = 0; k < 200; ++k) {
      JointVec q(arm.dof());
      for (double& x : q) x = rng.uniform(-3, 3);
      if (!keeper->project({q.data(), 6})) continue;
      ++done;
      EXPECT_GT(testing::most_room(region, fk(arm, as_span(q))), 1e-3);
      EXPECT_TRUE(keeper->keeps(as_span(q)));
      least = std::min(least, value_for(region, fk(arm, as_span(q))));
      most = std::max(most, value_for(region, fk(arm, as_span(q))));
    }
    EXPECT_GT(done, 60);
    const double range = region.mechanism->max - region.mechanism->min;
    EXPECT_GT(most - least, 0.8 * range) << "wherever it may stand";
  }
}

}  // namespace
}  // namespace mjarm
