#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <tuple>
#include <vector>

#include "mjarm/core/rng.hpp"
#include "mjarm/trajectory/point_to_point_checks_test.hpp"
#include "tests/support/constants.hpp"

namespace mjarm {
namespace {

using testing::duration;
using testing::limits_of;

struct Problem {
  JointState start, end;
  JointLimits limits;
};

double log_uniform(Rng& rng, double decades) {
  return std::pow(10, rng.uniform(-decades, decades));
}

/// A number in the range, quite often 0 or one of its ends.
double often_at_the_edge(Rng& rng, double max) {
  switch (static_cast<int>(rng.uniform(0, 8))) {
    case 0:
      return 0;
    case 1:
      return max;
    case 2:
      return -max;
    default:
      return rng.uniform(-max, max);
  }
}

/// An acceleration with which the joint neither overshoots its velocity limit nor comes from there.
double acceleration(Rng& rng, double v, double v_max, double a_max, double j) {
  const double room = std::sqrt(2 * j * std::max(0.0, v_max - std::abs(v)));
  return often_at_the_edge(rng, std::min(a_max, 0.999999 * room));
}

/// @param decades  how far the limits are apart. @param start_beyond  a start beyond its limits.
Problem random_problem(Rng& rng, int dof, double decades, bool start_beyond = false) {
  const JointVec zero = JointVec::Zero(dof);
  JointVec v = zero, a = zero, j = zero;
  JointState start{zero, zero, zero}, end{zero, zero, zero};
  for (int i = 0; i < dof; ++i) {
    v[i] = log_uniform(rng, decades);
    a[i] = log_uniform(rng, decades);
    j[i] = 10 * log_uniform(rng, decades);
    start.q[i] = rng.uniform(-3, 3);
    end.q[i] = rng.uniform(0, 1) < 0.2
                   ? start.q[i] + rng.uniform(-1, 1) * 1e-5 * log_uniform(rng, 4)
                   : rng.uniform(-3, 3);
    start.v[i] = often_at_the_edge(rng, v[i]);
    end.v[i] = often_at_the_edge(rng, v[i]);
    start.a[i] = acceleration(rng, start.v[i], v[i], a[i], j[i]);
    end.a[i] = acceleration(rng, end.v[i], v[i], a[i], j[i]);
    if (start_beyond) {
      start.v[i] *= rng.uniform(0, 2);
      start.a[i] = rng.uniform(-2, 2) * a[i];
    }
  }
  return {start, end, limits_of(v, a, j)};
}

TEST(PointToPointRandom, KeepsTheLimitsAndArrives) {
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    const Problem p = random_problem(rng, 1 + i % 4, 0.5);
    const auto motion = PointToPoint::solve(p.start, p.end, p.limits);
    ASSERT_TRUE(motion.has_value());
    const testing::Worst worst = testing::worst_of(*motion, p.end, p.limits);
    EXPECT_LT(std::max({worst.velocity, worst.acceleration, worst.jerk}), 1e-10);
    EXPECT_LT(std::max({worst.q, worst.v, worst.a}), 1e-10);
    const JointState first = motion->at(0);
    EXPECT_EQ(first.q, p.start.q);
    EXPECT_EQ(first.v, p.start.v);
    EXPECT_EQ(first.a, p.start.a);
  }
}

TEST(PointToPointRandom, KeepsLimitsThatAreFarApart) {
  Rng rng(2);
  for (int i = 0; i < 20000; ++i) {
    const Problem p = random_problem(rng, 1 + i % 3, 2);
    const auto motion = PointToPoint::solve(p.start, p.end, p.limits);
    ASSERT_TRUE(motion.has_value());
    // Times are rounded to 1e-16 of the duration, which the jerk turns into acceleration.
    const testing::Worst worst = testing::worst_of(*motion, p.end, p.limits);
    const double rounding = 1e-14 * motion->duration();
    const JointVec share = p.limits.jerk.cwiseQuotient(p.limits.acceleration);
    EXPECT_LT(worst.acceleration, 1e-10 + rounding * share.maxCoeff());
    EXPECT_LT(std::max(worst.velocity, worst.jerk), 1e-10);
    EXPECT_LT(worst.a, 1e-10 + rounding * p.limits.jerk.maxCoeff());
    EXPECT_LT(worst.v, 1e-10 + rounding * p.limits.acceleration.maxCoeff());
    EXPECT_LT(worst.q, 1e-10 + rounding * p.limits.velocity.maxCoeff());
  }
}

TEST(PointToPointRandom, ComesBackFromBeyondTheLimits) {
  Rng rng(3);
  for (int i = 0; i < 20000; ++i) {
    const Problem p = random_problem(rng, 1 + i % 3, 0.5, true);
    const auto motion = PointToPoint::solve(p.start, p.end, p.limits);
    ASSERT_TRUE(motion.has_value());
    const testing::Worst all = testing::worst_of(*motion, p.end, p.limits);
    EXPECT_LT(all.jerk, 1e-12);
    EXPECT_LT(std::max({all.q, all.v, all.a}), 1e-8);
    // A joint that is back once stays.
    JointVec back = JointVec::Zero(motion->dof());
    for (int k = 0; k <= 200; ++k) {
      const JointState x = motion->at(motion->duration() * k / 200);
      const JointVec flat =
          x.v + 0.5 * x.a.cwiseProduct(x.a.cwiseAbs()).cwiseQuotient(p.limits.jerk);
      for (int n = 0; n < motion->dof(); ++n) {
        const double v = p.limits.velocity[n] * (1 + 1e-9);
        const bool inside = std::abs(x.v[n]) < v && std::abs(flat[n]) < v &&
                            std::abs(x.a[n]) < p.limits.acceleration[n] * (1 + 1e-9);
        EXPECT_TRUE(inside || back[n] == 0);
        if (inside) back[n] = 1;
      }
    }
  }
}

TEST(PointToPointRandom, MirroredProblemsHaveMirroredAnswers) {
  Rng rng(4);
  for (int i = 0; i < 2000; ++i) {
    const Problem p = random_problem(rng, 3, 1, i % 2 == 0);
    const auto one = PointToPoint::solve(p.start, p.end, p.limits);
    const auto two = PointToPoint::solve({-p.start.q, -p.start.v, -p.start.a},
                                         {-p.end.q, -p.end.v, -p.end.a}, p.limits);
    ASSERT_TRUE(one.has_value() && two.has_value());
    EXPECT_NEAR(two->duration() / one->duration(), 1, 1e-12);
    for (int k = 0; k <= 20; ++k) {
      const double t = one->duration() * k / 20;
      EXPECT_LT((one->at(t).q + two->at(t).q).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((one->at(t).v + two->at(t).v).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST(PointToPointRandom, BackwardsTakesAsLong) {
  Rng rng(5);
  for (int i = 0; i < 5000; ++i) {
    const Problem p = random_problem(rng, 2, 0.5);
    const double there = duration(p.start, p.end, p.limits);
    const double back =
        duration({p.end.q, -p.end.v, p.end.a}, {p.start.q, -p.start.v, p.start.a}, p.limits);
    EXPECT_NEAR(back / there, 1, 1e-9);
  }
}

TEST(PointToPointRandom, UnitsDoNotMatter) {
  Rng rng(6);
  for (int i = 0; i < 5000; ++i) {
    const Problem p = random_problem(rng, 2, 0.5);
    const double t = log_uniform(rng, 3), s = log_uniform(rng, 3);
    const auto in_other_units = [&](const JointState& x) {
      return JointState{s * x.q, s / t * x.v, s / (t * t) * x.a};
    };
    const JointLimits limits =
        limits_of(s / t * p.limits.velocity, s / (t * t) * p.limits.acceleration,
                  s / (t * t * t) * p.limits.jerk);
    const double other = duration(in_other_units(p.start), in_other_units(p.end), limits);
    EXPECT_NEAR(other / t / duration(p.start, p.end, p.limits), 1, 1e-9);
  }
}

TEST(PointToPointRandom, SameInputSameBytes) {
  Rng rng(7);
  for (int i = 0; i < 500; ++i) {
    const Problem p = random_problem(rng, 7, 1, i % 2 == 0);
    const auto one = PointToPoint::solve(p.start, p.end, p.limits);
    const auto two = PointToPoint::solve(p.start, p.end, p.limits);
    ASSERT_TRUE(one.has_value() && two.has_value());
    for (int k = 0; k < one->dof(); ++k) {
      const auto a = one->pieces(k), b = two->pieces(k);
      ASSERT_EQ(a.size(), b.size());
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
    }
  }
}

// What is left of a fastest motion is a fastest motion.
TEST(PointToPointRandom, GoingOnFromTheMiddleIsNoFaster) {
  Rng rng(8);
  int longer = 0;
  for (int i = 0; i < 5000; ++i) {
    const Problem p = random_problem(rng, 1 + i % 2, 0.5);
    const auto motion = PointToPoint::solve(p.start, p.end, p.limits);
    ASSERT_TRUE(motion.has_value());
    const double t = rng.uniform(0, 0.9) * motion->duration();
    const double left = motion->duration() - t;
    const double again = duration(motion->at(t), p.end, p.limits);
    EXPECT_GT(again, left - 1e-5 * motion->duration());
    longer += again > left + 1e-5 * motion->duration();
  }
  // A motion that is possible at this instant only may be lost to rounding.
  EXPECT_LT(longer, 5);
}

/// A state on the lattice of motions whose jerk is +1, 0 or -1 for a second each: a, 2 v and 6 q
/// are integers, and v is largest where a is one of them.
using Lattice = std::tuple<int, int, int>;

JointState state_of(const Lattice& x) {
  const auto [a, v2, q6] = x;
  return {JointVec::Constant(1, q6 / 6.0), JointVec::Constant(1, v2 / 2.0),
          JointVec::Constant(1, a)};
}

// [s] What 1e-13 of the way are worth where a motion but touches its end.
constexpr double kTangent = 1e-6;

struct LatticeLimits {
  int a;
  int v2;
};

/// All states that are reached within the limits after 1, 2, ... seconds.
std::vector<std::set<Lattice>> layers(const Lattice& start, const LatticeLimits& limits,
                                      int count) {
  std::vector<std::set<Lattice>> all{{start}};
  for (int n = 0; n < count; ++n) {
    std::set<Lattice> next;
    for (const auto& [a, v2, q6] : all.back()) {
      for (const int jerk : {-1, 0, 1}) {
        const Lattice x{a + jerk, v2 + 2 * a + jerk, q6 + 3 * v2 + 3 * a + jerk};
        if (std::abs(std::get<0>(x)) <= limits.a && std::abs(std::get<1>(x)) <= limits.v2) {
          next.insert(x);
        }
      }
    }
    all.push_back(std::move(next));
  }
  return all;
}

/// Neither overshoots the velocity limit (`sign` 1) nor comes from there (-1).
bool inside(const Lattice& x, const LatticeLimits& limits, int sign) {
  const int a = std::get<0>(x);
  return std::abs(std::get<1>(x) + sign * a * std::abs(a)) <= limits.v2;
}

Lattice random_start(Rng& rng, const LatticeLimits& limits) {
  for (;;) {
    const auto integer = [&](int max) {
      return static_cast<int>(std::floor(rng.uniform(-max, max + 1)));
    };
    const Lattice x{integer(limits.a), integer(limits.v2), 0};
    if (inside(x, limits, 1)) return x;
  }
}

/// How many states of the lattice are reached later than on it, of how many, with that jerk.
std::pair<int, int> later_than_brute_force(Rng& rng, double jerk) {
  int later = 0, count = 0;
  for (int i = 0; i < 40; ++i) {
    const LatticeLimits limits{1 + i % 3, 2 + static_cast<int>(rng.uniform(0, 12))};
    const Lattice start = random_start(rng, limits);
    const auto reached = layers(start, limits, 12);
    const JointLimits bounds =
        limits_of(JointVec::Constant(1, limits.v2 / 2.0), JointVec::Constant(1, limits.a),
                  JointVec::Constant(1, jerk));
    for (std::size_t n = 1; n < reached.size(); ++n) {
      for (const Lattice& end : reached[n]) {
        if (!inside(end, limits, -1) ||
            rng.uniform(0, 1) > 50 / static_cast<double>(reached[n].size()))
          continue;
        const auto motion = PointToPoint::solve(state_of(start), state_of(end), bounds);
        const double t = motion ? motion->duration() : support::kInf;
        later += t > static_cast<double>(n) + kTangent;
        ++count;
      }
    }
  }
  return {later, count};
}

TEST(PointToPointBruteForce, NoMotionOfALatticeIsFaster) {
  Rng rng(9);
  const auto [later, count] = later_than_brute_force(rng, 1);
  EXPECT_EQ(later, 0);
  EXPECT_GT(count, 5000);
}

TEST(PointToPointBruteForce, WouldSeeAJerkTwoPercentTooSmall) {
  Rng rng(9);
  EXPECT_GT(later_than_brute_force(rng, 0.98).first, 20);
}

// Common durations: whatever two joints both reach at the same time on their lattices.
TEST(PointToPointBruteForce, NoTwoMotionsOfALatticeAreFasterTogether) {
  Rng rng(10);
  int count = 0, waiting = 0, later = 0;
  for (int i = 0; i < 40; ++i) {
    const LatticeLimits limits[] = {{1 + i % 3, 4 + i % 7}, {2, 2 + i % 11}};
    const Lattice start[] = {random_start(rng, limits[0]), random_start(rng, limits[1])};
    const std::vector<std::set<Lattice>> reached[] = {layers(start[0], limits[0], 10),
                                                      layers(start[1], limits[1], 10)};
    const JointLimits bounds =
        limits_of(Eigen::Vector2d(limits[0].v2 / 2.0, limits[1].v2 / 2.0),
                  Eigen::Vector2d(limits[0].a, limits[1].a), JointVec::Ones(2));
    const auto both = [](const JointState& a, const JointState& b) {
      return JointState{Eigen::Vector2d(a.q[0], b.q[0]), Eigen::Vector2d(a.v[0], b.v[0]),
                        Eigen::Vector2d(a.a[0], b.a[0])};
    };
    for (std::size_t n = 1; n < reached[0].size(); ++n) {
      auto b = reached[1][n].begin();
      for (const Lattice& a : reached[0][n]) {
        if (++b == reached[1][n].end()) b = reached[1][n].begin();
        if (!inside(a, limits[0], -1) || !inside(*b, limits[1], -1)) continue;
        if (rng.uniform(0, 1) > 50 / static_cast<double>(reached[0][n].size())) continue;
        const JointState from = both(state_of(start[0]), state_of(start[1]));
        const JointState to = both(state_of(a), state_of(*b));
        const double together = duration(from, to, bounds);
        later += together > static_cast<double>(n) + kTangent;
        const auto alone = [&](const Lattice& x, const Lattice& y, int k) {
          return duration(state_of(x), state_of(y),
                          limits_of(JointVec::Constant(1, bounds.velocity[k]),
                                    JointVec::Constant(1, bounds.acceleration[k]),
                                    JointVec::Constant(1, bounds.jerk[k])));
        };
        waiting += together > std::max(alone(start[0], a, 0), alone(start[1], *b, 1)) + 1e-9;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 5000);
  // Lattices are full of motions that are possible at one instant only, where rounding decides.
  EXPECT_LT(later, count / 1000);
  EXPECT_GT(waiting, 50);  // durations at which one of the two could not have arrived
}

}  // namespace
}  // namespace mjarm
