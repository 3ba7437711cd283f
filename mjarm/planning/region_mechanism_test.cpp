// Regions that hang on a mechanism, beside a search over all its values.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/long_tests_test.hpp"
#include "mjarm/planning/hung_region_test.hpp"
#include "mjarm/planning/task_region.hpp"

namespace mjarm {
namespace {

using std::numbers::pi;
using testing::most_room;
using testing::moved_region;

Eigen::Vector3d normal_vector(Rng& rng) { return {rng.normal(), rng.normal(), rng.normal()}; }

/// Bounds of every kind on a hinge or a slide, whose axis is also along or across those of R.
TaskRegion hung_region(Rng& rng) {
  TaskRegion out{.X_WR = {normal_vector(rng), rotation_exp(normal_vector(rng))},
                 .X_FT = {0.2 * normal_vector(rng), rotation_exp(normal_vector(rng))}};
  for (int k = 0; k < 3; ++k) {
    const double low = rng.uniform(-0.4, 0.1), farthest = k == 1 ? kFreePitch : kFreeTurn;
    out.place_min[k] = rng.uniform() < 0.4 ? -kFreePlace : low;
    out.place_max[k] = rng.uniform() < 0.4 ? kFreePlace : low + rng.uniform(0.01, 0.5);
    const double least = rng.uniform(-farthest, 0.8 * farthest);
    const bool is_free = rng.uniform() < 0.5;
    out.turn_min[k] = is_free ? -farthest : least;
    out.turn_max[k] = is_free ? farthest : rng.uniform(least + 0.02, farthest);
  }
  if (rng.uniform() < 0.3) out.lean = rng.uniform(0.1, pi);
  Mechanism by{.type = rng.uniform() < 0.7 ? JointType::hinge : JointType::slide};
  by.axis_W = rng.uniform() < 0.5 ? normal_vector(rng).normalized()
                                  : Eigen::Vector3d(out.X_WR.R.col(static_cast<int>(rng.below(3))));
  by.p_W = out.X_WR.p + rng.uniform(0, 0.6) * normal_vector(rng);
  by.min = rng.uniform(-2, 1);
  by.max = by.min + rng.uniform(0, 2);
  if (by.type == JointType::hinge && rng.uniform() < 0.2) {
    by.min = -pi;
    by.max = pi;
  }
  out.mechanism = by;
  return out;
}

TEST(RegionMechanism, APoseIsWithinIfItIsForAnyValue) {
  Rng rng(11);
  int inside = 0, outside = 0;
  const int cases = testing::rounds(120, 12'000);
  for (int k = 0; k < cases; ++k) {
    const TaskRegion region = hung_region(rng);
    if (!is_sound(region)) continue;
    const Mechanism& by = *region.mechanism;
    for (int i = 0; i < 4; ++i) {
      // Drawn within at some value, and moved to about the border.
      const TaskRegion somewhere = moved_region(region, rng.uniform(by.min, by.max));
      const Pose drawn = draw_from(somewhere, somewhere.X_WR.p, 1, rng);
      EXPECT_TRUE(room_in(region, drawn).within(1e-7)) << k;
      const double far = i == 0 ? 0 : rng.uniform(0, 0.3);
      const Pose X_WT{drawn.p + far * normal_vector(rng),
                      rotation_exp(far * normal_vector(rng)) * drawn.R};
      const double value = value_for(region, X_WT);
      EXPECT_GE(value, by.min);
      EXPECT_LE(value, by.max);
      const RegionRoom room = room_in(region, X_WT),
                       there = room_in(moved_region(region, value), X_WT);
      EXPECT_NEAR(std::min(room.place, 9.0), std::min(there.place, 9.0), 1e-9);
      EXPECT_NEAR(std::min(room.turn, 9.0), std::min(there.turn, 9.0), 1e-7);
      const double best = most_room(region, X_WT);
      if (best > 1e-7) {
        ++inside;
        EXPECT_TRUE(room.within(1e-7)) << k << " " << best << " " << room.place << " " << room.turn;
      } else if (best < -1e-5) {
        ++outside;
        EXPECT_FALSE(room.within(-best / 2)) << k;
      }
    }
  }
  EXPECT_GT(inside, cases);
  EXPECT_GT(outside, cases / 2);
}

TEST(RegionMechanism, ItsMiddleWhatIsDrawnAndWhatIsNearestAreWithin) {
  Rng rng(12);
  for (int k = 0; k < 200; ++k) {
    const TaskRegion region = hung_region(rng);
    if (!is_sound(region)) continue;
    EXPECT_TRUE(room_in(region, middle_of(region)).within(1e-7));
    const Pose drawn = draw_from(region, region.X_WR.p, 1, rng);
    EXPECT_TRUE(room_in(region, drawn).within(1e-7));
    EXPECT_LT((nearest_in(region, drawn).p - drawn.p).norm(), 1e-6);
    EXPECT_LT(angle_between(nearest_in(region, drawn).R, drawn.R), 1e-6);
    const Pose anywhere{normal_vector(rng), rotation_exp(normal_vector(rng))};
    EXPECT_TRUE(room_in(region, nearest_in(region, anywhere)).within(1e-7));
  }
}

/// The handle of a door, 0.3 m from its hinge, which is along `axis`; the hand may turn in it.
TaskRegion handle(const Eigen::Vector3d& axis) {
  const Eigen::Matrix3d R = rotation_between(Eigen::Vector3d::UnitZ(), axis);
  TaskRegion out =
      region_about({R * Eigen::Vector3d(0.3, 0, 0), R}, Eigen::Vector3d::Constant(0.01), 0.05, 0.7);
  out.mechanism = Mechanism{.axis_W = axis, .min = 0, .max = 1.2};
  return out;
}

TEST(RegionMechanism, ADoorStandsWhereTheHandleIs) {
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 2, -2)}) {
    const TaskRegion door = handle(axis.normalized());
    for (const double angle : {0.0, 0.3, 1.2}) {
      const Pose held = moved_region(door, angle).X_WR;
      EXPECT_NEAR(value_for(door, held), angle, 1e-9);
      EXPECT_NEAR(room_in(door, held).place, 0.01, 1e-9);
      EXPECT_NEAR(room_in(door, held).turn, 0.05, 1e-7);
      // A turn of the hand in the handle does not open the door, nor does more than it can turn.
      const Pose turned{held.p, held.R * from_euler({0, 0, 0.5})};
      EXPECT_NEAR(value_for(door, turned), angle, 1e-9);
      const Pose twisted{held.p, held.R * from_euler({0, 0, 1.5})};
      EXPECT_FALSE(room_in(door, twisted).within());
    }
    // Behind its stop the door stands at the stop.
    const Pose behind = moved_region(door, 1.22).X_WR, far = moved_region(door, 1.3).X_WR;
    EXPECT_EQ(value_for(door, behind), 1.2);
    EXPECT_TRUE(room_in(door, behind).within());
    EXPECT_FALSE(room_in(door, far).within());
    EXPECT_LT((nearest_in(door, far).p - moved_region(door, 1.2).X_WR.p).norm(), 0.02);
  }
}

TEST(RegionMechanism, ADrawerStandsWhereItsHandleIs) {
  TaskRegion drawer = region_about({{0.4, 0, 0.3}, from_euler({0.1, 0.2, 0.3})},
                                   {0.01, kFreePlace, 0.02}, 0.1, 0.1);
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 0.2, 0.1).normalized();
  drawer.mechanism = Mechanism{.type = JointType::slide, .axis_W = axis, .min = 0, .max = 0.3};
  for (const double value : {0.0, 0.1, 0.3}) {
    const Pose held{drawer.X_WR.p + value * axis, drawer.X_WR.R};
    EXPECT_NEAR(value_for(drawer, held), value, 1e-9);
    EXPECT_NEAR(room_in(drawer, held).place, 0.01, 1e-9);
  }
  EXPECT_FALSE(room_in(drawer, {drawer.X_WR.p + 0.35 * axis, drawer.X_WR.R}).within());
}

TEST(RegionMechanism, OutsideADrawerStandsWhereTheLeastIsMissing) {
  TaskRegion drawer =
      region_about({Eigen::Vector3d::Zero(), from_euler({0, 0, pi / 3})}, {0.01, 0.01, 0.01});
  // Off the axis of R by 1.3e-5 rad, as one is that was written with three digits; or by much.
  for (const Eigen::Vector3d& along :
       {Eigen::Vector3d(0.5, 0.866, 0), Eigen::Vector3d(0.4, 0.9, 0.1)}) {
    const Eigen::Vector3d axis = along.normalized(), aside = axis.unitOrthogonal();
    drawer.mechanism = Mechanism{.type = JointType::slide, .axis_W = axis, .min = 0, .max = 0.4};
    for (const double off : {0.0101, 0.012, 0.05, -0.02}) {
      const Pose X_WT{0.1 * axis + off * aside, drawer.X_WR.R};
      EXPECT_NEAR(std::min(0.0, room_in(drawer, X_WT).place), most_room(drawer, X_WT), 1e-6) << off;
    }
  }
}

TEST(RegionMechanism, OfTwoGapsAlikeRoundingDoesNotChoose) {
  TaskRegion line = region_about({}, {0.01, kFreePlace, kFreePlace}, pi, pi);
  line.mechanism = Mechanism{.axis_W = Eigen::Vector3d::UnitZ(), .min = -pi, .max = pi};
  double last = value_for(line, {{0.3, 0.1, 0}, Eigen::Matrix3d::Identity()});
  for (int k = 1; k <= 200; ++k) {
    const double angle = std::atan2(0.1, 0.3) + 0.003 * k, far = 0.32 + 0.0002 * k;
    const double value = value_for(
        line, {{far * std::cos(angle), far * std::sin(angle), 0}, Eigen::Matrix3d::Identity()});
    EXPECT_NEAR(value, last, 0.01) << k;
    last = value;
  }
}

TEST(RegionMechanism, OneThatStandsStillIsOneRegion) {
  Rng rng(13);
  for (int k = 0; k < 200; ++k) {
    TaskRegion region = hung_region(rng);
    region.mechanism->max = region.mechanism->min;
    if (!is_sound(region)) continue;
    const TaskRegion alone = moved_region(region, region.mechanism->min);
    const Pose X_WT{normal_vector(rng), rotation_exp(normal_vector(rng))};
    EXPECT_EQ(value_for(region, X_WT), region.mechanism->min);
    const RegionRoom room = room_in(region, X_WT), other = room_in(alone, X_WT);
    EXPECT_NEAR(std::min(room.place, 99.0), std::min(other.place, 99.0), 1e-9);
    EXPECT_NEAR(std::min(room.turn, 9.0), std::min(other.turn, 9.0), 1e-7);
    EXPECT_LT((middle_of(region).p - middle_of(alone).p).norm(), 1e-9);
    EXPECT_LT((nearest_in(region, X_WT).p - nearest_in(alone, X_WT).p).norm(), 1e-6);
  }
}

TEST(RegionMechanism, RefusesRangesAndAxesThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto broken = [](const auto& change) {
    TaskRegion region = handle(Eigen::Vector3d::UnitZ());
    change(*region.mechanism);
    EXPECT_EQ(is_sound(region), can_be_kept(region));
    return !is_sound(region);
  };
  EXPECT_FALSE(broken([](Mechanism&) {}));
  EXPECT_FALSE(broken([](Mechanism& m) { m.max = m.min; }));
  EXPECT_TRUE(broken([](Mechanism& m) { m.max = -0.1; }));
  EXPECT_TRUE(broken([](Mechanism& m) { m.max = 6.4; }));
  EXPECT_TRUE(broken([&](Mechanism& m) { m.min = nan; }));
  EXPECT_TRUE(broken([&](Mechanism& m) { m.p_W[1] = nan; }));
  EXPECT_TRUE(broken([](Mechanism& m) { m.axis_W *= 2; }));
  EXPECT_TRUE(broken([](Mechanism& m) {
    m.type = JointType::slide;
    m.max = kFreePlace;
  }));
}

}  // namespace
}  // namespace mjarm
