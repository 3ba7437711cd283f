#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

/// What a number does along an edge: its bounds at the ends, and anywhere.
struct Span {
  double ends_min = 1e9, ends_max = -1e9, min = 1e9, max = -1e9;

  void add(double value, bool end) {
    min = std::min(min, value);
    max = std::max(max, value);
    if (!end) return;
    ends_min = std::min(ends_min, value);
    ends_max = std::max(ends_max, value);
  }
  /// A bound that both ends keep, and what lies between them or not.
  [[nodiscard]] double above(Rng& rng) const {
    return ends_max + rng.uniform(0, 1.6) * (max - ends_max) + 1e-6;
  }
  [[nodiscard]] double below(Rng& rng) const {
    return ends_min - rng.uniform(0, 1.6) * (ends_min - min) - 1e-6;
  }
};

Eigen::Matrix3d with_z(const Eigen::Vector3d& z) {
  return rotation_between(Eigen::Vector3d::UnitZ(), z);
}

/// Bounds of all kinds that the ends of an edge keep.
TaskRegion region_along(const Arm& arm, const JointVec& q0, const JointVec& q1, Rng& rng) {
  TaskRegion out{.X_FT = {{rng.uniform(-0.2, 0.2), 0, 0.1}, rotation_exp({rng.normal(), 0.3, 0})}};
  out.X_WR.R = rotation_exp({0, 0, rng.normal()});
  // Turns about z of R at the base, or about z of F at the tool, count for less.
  const ArmJoint &first = arm.joints.front(), &last = arm.joints.back();
  if (rng.uniform() < 0.5) out.X_WR.R = with_z(first.X_PJ.R * first.axis);
  if (rng.uniform() < 0.5) out.X_FT.R = with_z(arm.X_JT.R.transpose() * last.axis).transpose();
  std::array<Span, 3> place, turn;
  Span lean;
  constexpr int kSamples = 30;
  for (int i = 0; i <= kSamples; ++i) {
    const JointVec q = q0 + static_cast<double>(i) / kSamples * (q1 - q0);
    const Pose X_RF = out.X_WR.inverse() * fk(arm, as_span(q)) * out.X_FT.inverse();
    const Eigen::Vector3d rpy = to_euler(X_RF.R);
    const bool end = i == 0 || i == kSamples;
    for (std::size_t k = 0; k < 3; ++k) {
      place[k].add(X_RF.p[static_cast<Eigen::Index>(k)], end);
      turn[k].add(rpy[static_cast<Eigen::Index>(k)], end);
    }
    lean.add(std::acos(std::clamp(X_RF.R(2, 2), -1.0, 1.0)), end);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double farthest = k == 1 ? kFreePitch : kFreeTurn;
    out.place_min[axis] = rng.uniform() < 0.7 ? -kFreePlace : place[k].below(rng);
    out.place_max[axis] = rng.uniform() < 0.7 ? kFreePlace : place[k].above(rng);
    // Not where roll and yaw jump, or change fast.
    const bool calm = turn[1].max < 1.3 && turn[1].min > -1.3 && turn[k].max - turn[k].min < 2.5;
    const bool is_free = !calm || rng.uniform() < 0.6;
    out.turn_min[axis] = is_free ? -farthest : std::max(turn[k].below(rng), -farthest);
    out.turn_max[axis] = is_free ? farthest : std::min(turn[k].above(rng), farthest);
  }
  if (rng.uniform() < 0.4) out.lean = std::min(lean.above(rng), pi);
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
  const double way = rng.uniform(0.1, 1.2);
  for (int i = 0; i < arm.dof(); ++i) {
    q0[i] = rng.uniform(-2, 2);
    q1[i] = q0[i] + rng.uniform(-way, way);
  }
  const TaskRegion region = region_along(arm, q0, q1, rng);
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
  const int cases = testing::rounds(700, 70'000);
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
  EXPECT_GT(left, cases / 8);
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
