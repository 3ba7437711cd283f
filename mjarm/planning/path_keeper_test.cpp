#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/arms_test.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/planning/covered_arm_test.hpp"
#include "mjarm/planning/goals_test.hpp"
#include "mjarm/planning/path_keeper_internal.hpp"

namespace mjarm {
namespace {

using detail::PathKeeper;
using std::numbers::pi;

/// Bounds round where the tool is, of all kinds.
TaskRegion region_round(const Pose& X_WT, Rng& rng) {
  TaskRegion out{.X_FT = {{rng.uniform(-0.2, 0.2), 0, 0.1}, rotation_exp({rng.normal(), 0.3, 0})}};
  out.X_WR.R =
      rng.uniform() < 0.5 ? Eigen::Matrix3d::Identity() : rotation_exp({0, 0, rng.normal()});
  const Pose X_RF = out.X_WR.inverse() * X_WT * out.X_FT.inverse();
  const Eigen::Vector3d rpy = to_euler(X_RF.R);
  for (int k = 0; k < 3; ++k) {
    const double farthest = k == 1 ? kFreePitch : kFreeTurn;
    const double wide = std::exp(rng.uniform(-6, 0)),
                 turn = std::exp(rng.uniform(-5, k == 1 ? 0 : 1.2));
    out.place_min[k] = rng.uniform() < 0.4 ? -kFreePlace : X_RF.p[k] - wide;
    out.place_max[k] = rng.uniform() < 0.4 ? kFreePlace : X_RF.p[k] + wide;
    const bool is_free = rng.uniform() < 0.6;
    out.turn_min[k] = is_free ? -farthest : std::max(rpy[k] - turn, k == 1 ? -farthest : -2 * pi);
    out.turn_max[k] = is_free ? farthest : std::min(rpy[k] + turn, k == 1 ? farthest : 2 * pi);
  }
  const double leans = std::acos(X_RF.R(2, 2));
  if (rng.uniform() < 0.5) out.lean = std::min(leans + rng.uniform(0.01, 1), pi);
  return out;
}

/// Of some edge of some arm: what is proved, and what samples tell.
struct Looked {
  PathKeeper::Edge edge;
  RegionRoom least = {};       ///< at samples
  RegionRoom at_refusal = {};  ///< where the proof was given up
};

Looked look_somewhere(Rng& rng) {
  const Arm arm = testing::random_arm(2 + static_cast<int>(rng.below(6)), rng);
  JointVec q0(arm.dof()), q1(arm.dof());
  const double way = rng.uniform(0.02, 1);
  for (int i = 0; i < arm.dof(); ++i) {
    q0[i] = rng.uniform(-2, 2);
    q1[i] = q0[i] + rng.uniform(-way, way);
  }
  const TaskRegion region = region_round(fk(arm, as_span(q0)), rng);
  const auto keeper = PathKeeper::create({.within = region}, arm);
  const auto room = [&](double t) {
    const JointVec q = q0 + t * (q1 - q0);
    return room_in(region, fk(arm, as_span(q)));
  };
  Looked out{.edge = keeper->look(as_span(q0), as_span(q1))};
  for (int i = 0; i <= 100; ++i) {
    out.least.place = std::min(out.least.place, room(i / 100.0).place);
    out.least.turn = std::min(out.least.turn, room(i / 100.0).turn);
  }
  out.at_refusal = room(out.edge.t);
  return out;
}

TEST(PathKeeper, EdgesThatAreKeptAreSoAtEveryPlaceAndOthersAreNotAtTheirs) {
  Rng rng(5);
  int kept = 0, left = 0;
  const int cases = testing::rounds(600, 60'000);
  for (int k = 0; k < cases; ++k) {
    const Looked looked = look_somewhere(rng);
    if (looked.edge.kept) {
      ++kept;
      EXPECT_TRUE(looked.least.within(2e-9));
      EXPECT_LE(looked.edge.room.place, looked.least.place + 1e-9);
      EXPECT_LE(looked.edge.room.turn, looked.least.turn + 1e-7);
    } else {
      ++left;
      // Within 1e-4 of where it was given up a bound is met or crossed.
      EXPECT_FALSE(looked.at_refusal.within(-2e-3))
          << looked.at_refusal.place << " " << looked.at_refusal.turn;
    }
  }
  EXPECT_GT(kept, cases / 10);
  EXPECT_GT(left, cases / 4);
}

TEST(PathKeeper, EdgesWithoutEndAreGivenUp) {
  const Arm arm = testing::ur5e();
  const JointVec q0 = JointVec::Zero(6);
  const auto keeper = PathKeeper::create({.tilt = keep_upright(arm, as_span(q0), 0.1)}, arm);
  JointVec q1 = q0;
  q1[3] = 1e12;
  EXPECT_FALSE(keeper->look(as_span(q0), as_span(q1)).kept);
  q1 = q0;
  q1[0] = 1e17;  // about the vertical: nothing to look at
  EXPECT_TRUE(keeper->look(as_span(q0), as_span(q1)).kept);
}

TEST(PathKeeper, PutsBackWithinAllBoundsOrSaysThatItCannot) {
  const Arm arm = testing::ur5e();
  Rng rng(7);
  TaskRegion layer =
      region_about({{0, 0, 0.3}, from_euler({pi, 0, 0})}, {kFreePlace, kFreePlace, 0.02}, pi, pi);
  layer.place_max[0] = 0.5;
  TaskRegion heading = layer;  // and the hand does not turn much
  heading.turn_min[2] = -0.4;
  heading.turn_max[2] = 0.2;
  for (const TaskRegion& region : {layer, heading}) {
    const TiltLimit tilted{.max = 0.1};
    const auto keeper = PathKeeper::create({.tilt = tilted, .within = region}, arm);
    int done = 0;
    for (int k = 0; k < 200; ++k) {
      JointVec q(arm.dof());
      for (double& x : q) x = rng.uniform(-3, 3);
      if (!keeper->project({q.data(), 6})) continue;
      ++done;
      EXPECT_LE(tilt(tilted, arm, as_span(q)), 0.031);
      EXPECT_GT(room_in(region, fk(arm, as_span(q))).place, 0.01);
      EXPECT_GT(room_in(region, fk(arm, as_span(q))).turn, 0.05);
      EXPECT_TRUE(keeper->keeps(as_span(q)));
      const JointVec there = q;
      EXPECT_TRUE(keeper->project({q.data(), 6}));
      EXPECT_EQ(q, there);
    }
    EXPECT_GT(done, 100);
  }
}

}  // namespace
}  // namespace mjarm
