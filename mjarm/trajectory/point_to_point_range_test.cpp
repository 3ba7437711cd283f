#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/point_to_point_checks_test.hpp"
#include "tests/support/constants.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm {
namespace {

using testing::limits_of;

constexpr double kBrakeStep = 1e-4;  // [s] of braking by brute force

/// How far a joint goes up at most when it brakes as hard as it can, in small steps of time.
double braked_way(double v, double a, double a_max, double j) {
  double q = 0, highest = 0;
  while (v > 0 || a > 0) {
    q += kBrakeStep * (v + kBrakeStep * a / 2);
    v += kBrakeStep * a;
    a = std::max(a - kBrakeStep * j, -a_max);
    highest = std::max(highest, q);
  }
  return highest;
}

/// How far beyond its range a state must go after it (`sign` 1) or was before it (-1); below 0: the
/// least distance from its ends.
double braked_beyond(const JointState& x, const JointLimits& limits, int i, int sign) {
  const double a = limits.acceleration[i], j = limits.jerk[i];
  return std::max(x.q[i] + braked_way(sign * x.v[i], x.a[i], a, j) - limits.upper[i],
                  limits.lower[i] - x.q[i] + braked_way(-sign * x.v[i], -x.a[i], a, j));
}

/// Random limits of `dof` joints with ranges of about that half.
JointLimits random_limits(Rng& rng, int dof, double half) {
  JointVec ends[2], v(dof), a(dof), j(dof);
  ends[0] = ends[1] = JointVec::Zero(dof);
  for (int i = 0; i < dof; ++i) {
    ends[0][i] = -half * rng.uniform(0.7, 1.3);
    ends[1][i] = half * rng.uniform(0.7, 1.3);
    v[i] = rng.uniform(1, 4);
    a[i] = rng.uniform(2, 15);
    j[i] = a[i] * rng.uniform(3, 30);
  }
  JointLimits limits = limits_of(v, a, j);
  limits.lower = ends[0];
  limits.upper = ends[1];
  return limits;
}

/// A state near one end of each joint's range, at any velocity; joints that would be too fast
/// before their acceleration is gone have none.
JointState state_near_the_ends(Rng& rng, const JointLimits& limits, int i, JointState x) {
  const double away = std::min(std::pow(10, rng.uniform(-4, 0)), limits.upper[i]);
  x.q[i] = rng.uniform() < 0.5 ? limits.upper[i] - away : limits.lower[i] + away;
  x.v[i] = limits.velocity[i] * (rng.uniform() < 0.5 ? rng.uniform(-1, 1) : rng.uniform(-0.2, 0.2));
  if (rng.uniform() < 0.2) x.v[i] = 0;
  const double room = std::sqrt(2 * limits.jerk[i] * (limits.velocity[i] - std::abs(x.v[i])));
  const double most = 0.999 * std::min(limits.acceleration[i], room);
  x.a[i] = rng.uniform() < 0.3 ? 0 : rng.uniform(-most, most);
  return x;
}

/// One that can stay in its range (`sign` 1) or come from there (-1).
JointState random_state(Rng& rng, const JointLimits& limits, int sign) {
  const JointVec zero = JointVec::Zero(limits.velocity.size());
  JointState x{zero, zero, zero};
  for (int i = 0; i < zero.size(); ++i) {
    do {
      x = state_near_the_ends(rng, limits, i, x);
    } while (braked_beyond(x, limits, i, sign) > -1e-3);
  }
  return x;
}

/// The farthest beyond its range any joint gets [rad]: at the exact extremes of the pieces, and at
/// 500 samples.
double beyond(const PointToPoint& motion, const JointLimits& limits) {
  double worst = -support::kInf;
  const auto look = [&](int i, double q) {
    worst = std::max({worst, q - limits.upper[i], limits.lower[i] - q});
  };
  for (int i = 0; i < motion.dof(); ++i) {
    const auto pieces = motion.pieces(i);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const PointToPoint::Piece& p = pieces[k];
      const double h = (k + 1 < pieces.size() ? pieces[k + 1].t : motion.duration()) - p.t;
      const double root = std::sqrt(std::max(0.0, p.a * p.a - 2 * p.jerk * p.v));
      for (const double x : {0.0, (-p.a + root) / p.jerk, (-p.a - root) / p.jerk, -p.v / p.a, h}) {
        if (x >= 0 && x <= h) look(i, p.q + x * (p.v + x * (p.a / 2 + x * p.jerk / 6)));
      }
    }
  }
  for (int k = 0; k <= 500; ++k) {
    const JointVec q = motion.at(motion.duration() * k / 500).q;
    for (int i = 0; i < motion.dof(); ++i) look(i, q[i]);
  }
  return worst;
}

JointLimits without_range(JointLimits limits) {
  limits.lower = limits.upper = {};
  return limits;
}

/// What becomes of random problems near the ends of ranges.
struct Tally {
  int legal = 0, other = 0, none = 0;
  double longest = 1;  // of the others, over the fastest motion without ranges
};
Tally tally_of(std::uint64_t seed, int count, double half) {
  Rng rng(seed);
  Tally tally;
  for (int n = 0; n < count; ++n) {
    const JointLimits limits = random_limits(rng, 1 + n % 6, half);
    const JointState start = random_state(rng, limits, 1), end = random_state(rng, limits, -1);
    const auto fastest = PointToPoint::solve(start, end, without_range(limits));
    const auto motion = PointToPoint::solve(start, end, limits);
    if (!motion) {
      EXPECT_EQ(motion.error().code, PointToPointErrc::no_room);
      EXPECT_GT(beyond(*fastest, limits), 0);
      ++tally.none;
      continue;
    }
    EXPECT_LT(beyond(*motion, limits), 1e-12);
    const testing::Worst worst = testing::worst_of(*motion, end, limits);
    EXPECT_LT(std::max({worst.velocity, worst.acceleration, worst.jerk}), 1e-9);
    EXPECT_LT(std::max({worst.q, worst.v, worst.a}), 1e-9);
    if (beyond(*fastest, limits) <= 0) {
      EXPECT_EQ(motion->duration(), fastest->duration());
      ++tally.legal;
    } else {
      EXPECT_GE(motion->duration(), fastest->duration());
      tally.longest = std::max(tally.longest, motion->duration() / fastest->duration());
      ++tally.other;
    }
  }
  return tally;
}

TEST(PointToPointRange, IsNeverLeft) {
  const int count = testing::rounds(2000, 20000, 500);
  const Tally tally = tally_of(1, count, 3);
  EXPECT_EQ(tally.none, 0);
  EXPECT_GT(tally.other, count / 10);
  EXPECT_GT(tally.legal, count / 10);
  EXPECT_LT(tally.longest, 1.02);
}

// Ranges hardly wider than what it takes to stop: two ways out of three lead beyond.
TEST(PointToPointRange, IsNeverLeftThoughNarrow) {
  const int count = testing::rounds(1000, 20000, 200);
  const Tally tally = tally_of(2, count, 0.4);
  EXPECT_LT(tally.none, count / 100);
  EXPECT_GT(tally.other, count / 10);
}

// Whatever a joint does, full braking keeps it lowest: what that leaves, every motion leaves.
TEST(PointToPointRange, SaysWhichJointCannotButLeaveIt) {
  Rng rng(3);
  int starts = 0, ends = 0;
  for (int n = 0; n < 2000; ++n) {
    const JointLimits limits = random_limits(rng, 3, 3);
    JointState start = random_state(rng, limits, 1), end = random_state(rng, limits, -1);
    const int i = n % 3, sign = n % 2 == 0 ? 1 : -1;
    JointState& bad = sign > 0 ? start : end;
    bad = state_near_the_ends(rng, limits, i, bad);
    const double over = braked_beyond(bad, limits, i, sign);
    if (over < 1e-2) continue;
    const auto fastest = PointToPoint::solve(start, end, without_range(limits));
    ASSERT_TRUE(fastest.has_value());
    if (beyond(*fastest, limits) <= 0) continue;  // over before it gets there
    const auto motion = PointToPoint::solve(start, end, limits);
    ASSERT_FALSE(motion.has_value());
    EXPECT_EQ(motion.error().code,
              sign > 0 ? PointToPointErrc::start_leaves_range : PointToPointErrc::end_leaves_range);
    EXPECT_EQ(motion.error().joint, i);
    EXPECT_NEAR(motion.error().beyond, over, 1e-3);
    const auto words = point_to_point(start, end, limits);
    ASSERT_FALSE(words.has_value());
    EXPECT_NE(words.error().what.find("joint " + std::to_string(i + 1)), std::string::npos);
    ++(sign > 0 ? starts : ends);
  }
  EXPECT_GT(starts, 100);
  EXPECT_GT(ends, 100);
}

JointVec pair_of(double x, double y) { return Eigen::Vector2d(x, y); }

// The second joint could not brake so gently as its share of the first one's time asks for.
TEST(PointToPointRange, TakesNoMoreTimeToWaitInIt) {
  JointLimits limits = limits_of(pair_of(1, 1), pair_of(5, 5), pair_of(50, 50));
  limits.lower = pair_of(-3, -3);
  limits.upper = pair_of(3, 3);
  const JointState start{pair_of(-2, 2.8), pair_of(0, 0.9), pair_of(0, 0)};
  const JointState end{pair_of(2, 2.7), pair_of(0, 0), pair_of(0, 0)};
  const auto fastest = PointToPoint::solve(start, end, without_range(limits));
  const auto motion = PointToPoint::solve(start, end, limits);
  ASSERT_TRUE(fastest.has_value() && motion.has_value());
  EXPECT_GT(beyond(*fastest, limits), 5e-3);
  EXPECT_LT(beyond(*motion, limits), 1e-12);
  EXPECT_EQ(motion->duration(), fastest->duration());
  const auto again = PointToPoint::solve(start, end, limits);
  for (int k = 0; k <= 50; ++k) {
    const double t = motion->duration() * k / 50;
    EXPECT_EQ(motion->at(t).q, again->at(t).q);
    EXPECT_EQ(motion->at(t).v, again->at(t).v);
  }
}

// On the left of a rest at its lower end there is no run-up: the joint goes up, turns, touches the
// end and comes back with the velocity asked for.
TEST(PointToPointRange, TurnsAtItsEnd) {
  JointLimits limits =
      limits_of(JointVec::Constant(1, 3), JointVec::Constant(1, 5), JointVec::Constant(1, 10));
  const auto state = [](double q, double v) {
    return JointState{JointVec::Constant(1, q), JointVec::Constant(1, v), JointVec::Zero(1)};
  };
  limits.lower = JointVec::Constant(1, -0.3);
  limits.upper = JointVec::Constant(1, 0.3);
  for (const double sign : {1.0, -1.0}) {
    const JointState start = state(-0.2985 * sign, 0), end = state(-0.2212 * sign, 0.41 * sign);
    const auto fastest = PointToPoint::solve(start, end, without_range(limits));
    const auto motion = PointToPoint::solve(start, end, limits);
    ASSERT_TRUE(fastest.has_value() && motion.has_value());
    EXPECT_GT(beyond(*fastest, limits), 1e-3);
    EXPECT_LT(beyond(*motion, limits), 1e-12);
    EXPECT_GT(motion->duration(), fastest->duration());
    EXPECT_LT(motion->duration(), 1.1);
  }
}

TEST(PointToPointRange, MayBeOpenOrMissing) {
  JointLimits limits = limits_of(pair_of(1, 1), pair_of(5, 5), pair_of(50, support::kInf));
  limits.upper[1] = 2.9;
  const JointState start{pair_of(-2, 2.8), pair_of(0, 0.9), pair_of(0, 0)};
  const JointState end{pair_of(2, 2.7), pair_of(0, 0), pair_of(0, 0)};
  const auto open = PointToPoint::solve(start, end, limits);
  ASSERT_TRUE(open.has_value());
  EXPECT_LT(beyond(*open, limits), 1e-12);
  EXPECT_GT(beyond(*PointToPoint::solve(start, end, without_range(limits)), limits), 0.05);
  const auto code = [&](const JointVec& lower, const JointVec& upper) {
    JointLimits bad = limits;
    bad.lower = lower;
    bad.upper = upper;
    const auto motion = PointToPoint::solve(start, end, bad);
    EXPECT_FALSE(motion.has_value());
    return motion ? PointToPointErrc{} : motion.error().code;
  };
  EXPECT_EQ(code(pair_of(-3, 1), pair_of(3, -1)), PointToPointErrc::bad_limits);
  EXPECT_EQ(code(pair_of(-3, support::kNaN), pair_of(3, 3)), PointToPointErrc::bad_limits);
  EXPECT_EQ(code(JointVec::Zero(1), JointVec::Ones(1)), PointToPointErrc::bad_limits);
}

}  // namespace
}  // namespace mjarm
