// What holds for every plan that has no faults, looked at from outside: by differences of the joint
// values, by the tool's place and by MuJoCo's own contacts.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/path/clearance.hpp"
#include "mjarm/program/program_plan.hpp"
#include "mjarm/trajectory/tool_down_test.hpp"

namespace mjarm::program {
namespace {

using Eigen::Vector3d;
using testing::kDown;
using testing::kSeed;

const Robot& measured_robot() {
  static const Robot kRobot = [] {
    Program program;
    program.robot = "ur5e";
    return load_program_robot(program, "").value();
  }();
  return kRobot;
}

ProgramPlan plan_with(std::vector<Instruction> instructions,
                      const ProgramPlanOptions& options = {}) {
  Program program;
  program.instructions = std::move(instructions);
  return plan_program(measured_robot().model, measured_robot().arm, program, options);
}

std::string told_of(const ProgramPlan& plan) {
  std::string out;
  for (const ProgramFault& fault : plan.faults) out += fault.reason + ": " + fault.what + "\n";
  return out;
}

/// A tool pose in front of the arm, away from it and from the floor; the tool points down, turned
/// and tilted a little.
Pose place_in_front(Rng& rng) {
  const double turn = rng.uniform(-0.5, 0.5) - std::numbers::pi / 2;
  const double radius = rng.uniform(0.38, 0.55);
  const double height = rng.uniform(0.25, 0.45);
  Vector3d tilt;
  for (double& angle : tilt) angle = rng.uniform(-0.15, 0.15);
  return {{radius * std::cos(turn), radius * std::sin(turn), height}, kDown * from_euler(tilt)};
}

std::vector<Instruction> random_instructions(Rng& rng) {
  std::vector<Instruction> out{move_j(kSeed, rng.uniform(0.2, 1))};
  out.push_back(move_j(place_in_front(rng), 0.6));
  const auto count = 2 + rng.below(4);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Pose X = place_in_front(rng);
    switch (rng.below(5)) {
      case 0:
        out.push_back(move_j(X, rng.uniform(0.1, 1)));
        break;
      case 1:
        out.push_back(move_l(X, rng.uniform(0.02, 0.2)));
        break;
      case 2:
        out.push_back(move_l(X, rng.uniform(0.02, 0.2), 0.01));
        out.push_back(move_l(place_in_front(rng), 0.1));
        break;
      case 3: {
        const Vector3d side(0.03, -0.02, 0.04);
        out.push_back(move_l(X));
        out.push_back(move_c({X.p + side, X.R}, {X.p + Vector3d(0.05, 0, 0.01), X.R}, 0.08));
        break;
      }
      default:
        out.push_back(wait(rng.uniform(0, 0.3)));
    }
  }
  return out;
}

/// Samples a motion, its ends included.
std::vector<JointVec> samples(const Trajectory& trajectory, double h) {
  std::vector<JointVec> out;
  const int count = static_cast<int>(trajectory.duration() / h);
  for (int i = 0; i <= count; ++i) out.push_back(trajectory.at(i * h).q);
  return out;
}

/// Speeds and accelerations are differences of positions alone; what the trajectory says of its
/// own speed is not asked.
void expect_within_limits(const PlannedMove& move, double share) {
  constexpr double kStep = 1e-3;
  const JointLimits& limits = measured_robot().arm.limits;
  const std::vector<JointVec> q = samples(move.trajectory, kStep);
  for (std::size_t i = 0; i < q.size(); ++i) {
    ASSERT_GE((q[i] - limits.lower).minCoeff(), -1e-9) << move.word;
    ASSERT_GE((limits.upper - q[i]).minCoeff(), -1e-9) << move.word;
    if (i == 0) continue;
    const JointVec v = (q[i] - q[i - 1]) / kStep;
    ASSERT_LE(v.cwiseAbs().cwiseQuotient(limits.velocity).maxCoeff(), share + 1e-6) << move.word;
    if (i == 1) continue;
    const JointVec a = (q[i] - 2 * q[i - 1] + q[i - 2]) / (kStep * kStep);
    ASSERT_LE(a.cwiseAbs().cwiseQuotient(limits.acceleration).maxCoeff(), share + 1e-4)
        << move.word << " at sample " << i;
  }
}

TEST(PlanInvariants, EveryJointKeepsItsLimitsAtEveryMomentAndNothingJumps) {
  Rng rng(31);
  for (int round = 0; round < 3; ++round) {
    const std::vector<Instruction> instructions = random_instructions(rng);
    const ProgramPlan plan = plan_with(instructions);
    ASSERT_TRUE(plan.ok()) << told_of(plan);
    std::size_t at = 0;
    JointVec q = plan.q_start;
    for (const PlannedMove& move : plan.moves) {
      const auto* joint_move = std::get_if<MoveJ>(&instructions.at(at).what);
      expect_within_limits(move, joint_move != nullptr ? joint_move->share.value_or(1) : 1);
      const double end = move.trajectory.duration();
      EXPECT_LT((move.trajectory.at(0).q - q).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT(move.trajectory.at(0).v.cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT(move.trajectory.at(end).v.cwiseAbs().maxCoeff(), 1e-9);
      q = move.trajectory.at(end).q;
      at += move.instructions;
    }
    EXPECT_EQ(at, instructions.size()) << "every instruction is done by one motion";
    EXPECT_EQ(plan.q_end(), q);
  }
}

TEST(PlanInvariants, WhatPassesTouchesNothingAndTheClearanceToldIsTheLeast) {
  Rng rng(32);
  ExactChecker checker(measured_robot().model, measured_robot().arm, {.skip_neighbours = true});
  const ClearanceCheck clearance = clearance_check(checker);
  for (int round = 0; round < 2; ++round) {
    const ProgramPlan plan = plan_with(random_instructions(rng));
    ASSERT_TRUE(plan.ok()) << told_of(plan);
    for (const PlannedMove& move : plan.moves) {
      if (!move.measures) continue;
      double least = std::numeric_limits<double>::infinity();
      double room = least;
      for (const JointVec& q : samples(move.trajectory, 0.02)) {
        ASSERT_TRUE(checker.is_free(as_span(q))) << describe(checker.check(as_span(q)).value());
        least = std::min(least, clearance(as_span(q)).distance);
        room = std::min({room, (measured_robot().arm.limits.upper - q).minCoeff(),
                         (q - measured_robot().arm.limits.lower).minCoeff()});
      }
      EXPECT_NEAR(move.measures->limit_room, room, 0.02) << move.word;
      if (!std::isfinite(least)) continue;
      // Both look at points of the same way; between two of them nothing moves over 2 cm.
      EXPECT_NEAR(move.measures->clearance, least, 0.02) << move.word;
    }
  }
}

/// The tool's speed by differences of its place.
double fastest(const ProgramPlan& plan, const PlannedMove& move) {
  constexpr double kStep = 1e-3;
  double out = 0;
  Vector3d before = fk(plan.arms[move.tool], as_span(move.trajectory.at(0).q)).p;
  for (double t = kStep; t <= move.trajectory.duration(); t += kStep) {
    const Vector3d p = fk(plan.arms[move.tool], as_span(move.trajectory.at(t).q)).p;
    out = std::max(out, (p - before).norm() / kStep);
    before = p;
  }
  return out;
}

TEST(PlanInvariants, StraightMovesAreStraightTurnEvenlyAndKeepTheirSpeed) {
  Rng rng(33);
  for (int round = 0; round < 4; ++round) {
    const Pose a = place_in_front(rng), b = place_in_front(rng);
    const double speed = rng.uniform(0.02, 0.15);
    const ProgramPlan plan = plan_with({move_j(kSeed), move_j(a), move_l(b, speed)});
    ASSERT_TRUE(plan.ok()) << told_of(plan);
    const PlannedMove& move = plan.moves.back();
    const Vector3d way = b.p - a.p;
    for (int i = 0; i <= 100; ++i) {
      const JointVec q = move.trajectory.at(move.trajectory.duration() * i / 100).q;
      const Pose X = fk(plan.arms[0], as_span(q));
      const double share = (X.p - a.p).dot(way) / way.squaredNorm();
      ASSERT_LT((X.p - a.p - share * way).norm(), 1e-5);
      // The axis of the turn is the same all along, and the angle grows with the way.
      const Eigen::AngleAxisd turn(a.R.transpose() * b.R);
      const Eigen::Matrix3d R =
          a.R * Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
      ASSERT_LT(angle_between(X.R, R), 1e-4);
    }
    EXPECT_NEAR(fastest(plan, move), speed, 0.01 * speed);
  }
}

TEST(PlanInvariants, BlendsLeaveTheirLinesOnlyNearTheCorner) {
  Rng rng(34);
  for (int round = 0; round < 4; ++round) {
    const Pose a = place_in_front(rng), b = place_in_front(rng), c = place_in_front(rng);
    const double room = 0.45 * std::min((b.p - a.p).norm(), (c.p - b.p).norm());
    const double blend = std::min(rng.uniform(0.005, 0.05), room);
    const ProgramPlan plan =
        plan_with({move_j(kSeed), move_j(a), move_l(b, 0.1, blend), move_l(c, 0.1)});
    ASSERT_TRUE(plan.ok()) << told_of(plan);
    ASSERT_EQ(plan.moves.size(), 3U);
    const PlannedMove& move = plan.moves.back();
    const auto off_leg = [](const Vector3d& p, const Vector3d& from, const Vector3d& to) {
      const Vector3d way = to - from;
      const double share = std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
      return (p - from - share * way).norm();
    };
    double nearest = 1;
    for (const JointVec& q : samples(move.trajectory, 5e-3)) {
      const Vector3d p = fk(plan.arms[0], as_span(q)).p;
      const double off = std::min(off_leg(p, a.p, b.p), off_leg(p, b.p, c.p));
      const double to_corner = (p - b.p).norm();
      if (to_corner > blend) {
        ASSERT_LT(off, 1e-5) << "corner " << to_corner;
      }
      ASSERT_LE(off, blend);
      nearest = std::min(nearest, to_corner);
    }
    EXPECT_GT(nearest, 1e-4) << "the corner is cut";
    EXPECT_LT(nearest, blend);
  }
}

/// Bit by bit, also for the second plan of the same process.
void expect_same(const ProgramPlan& a, const ProgramPlan& b) {
  ASSERT_EQ(a.moves.size(), b.moves.size());
  EXPECT_EQ(a.q_start, b.q_start);
  for (std::size_t i = 0; i < a.moves.size(); ++i) {
    const Trajectory &one = a.moves[i].trajectory, &other = b.moves[i].trajectory;
    EXPECT_EQ(a.moves[i].word, b.moves[i].word);
    ASSERT_EQ(one.duration(), other.duration()) << i;
    for (int k = 0; k <= 10; ++k) {
      const double t = one.duration() * k / 10;
      ASSERT_EQ(one.at(t).q, other.at(t).q) << i;
      ASSERT_EQ(one.at(t).a, other.at(t).a) << i;
    }
  }
}

TEST(PlanInvariants, TheSameSentencesGiveTheSameMotionHoweverTheyAreGrouped) {
  Rng rng(35);
  const Pose a = place_in_front(rng), b = place_in_front(rng);
  const std::vector<Instruction> body{move_l(a, 0.1), wait(0.1), move_l(b, 0.1)};
  std::vector<Instruction> unrolled{move_j(kSeed), move_j(b)};
  for (int i = 0; i < 2; ++i) unrolled.insert(unrolled.end(), body.begin(), body.end());
  const ProgramPlan plan = plan_with(unrolled);
  ASSERT_TRUE(plan.ok()) << told_of(plan);
  EXPECT_EQ(plan.moves.size(), 8U);
  expect_same(plan, plan_with(unrolled));
  expect_same(plan, plan_with({move_j(kSeed), move_j(b), repeat(2, body)}));
  expect_same(plan, plan_with({move_j(kSeed), move_j(b), repeat(1, {repeat(2, body)})}));
  // A repeat of nothing, or none at all, is nothing.
  expect_same(plan_with({move_j(kSeed), repeat(0, body), repeat(7, {}), wait(1)}),
              plan_with({move_j(kSeed), wait(1)}));
}

TEST(PlanInvariants, SlowerNeverTakesLessTime) {
  const Pose a{{0.2, -0.45, 0.4}, kDown}, b{{-0.2, -0.45, 0.4}, kDown};
  double before = 0;
  for (const double speed : {0.3, 0.1, 0.02}) {
    const ProgramPlan plan = plan_with({move_j(a), move_l(b, speed)});
    ASSERT_TRUE(plan.ok()) << told_of(plan);
    const double duration = plan.moves.back().trajectory.duration();
    EXPECT_GT(duration, before);
    EXPECT_GE(duration, 0.4 / speed) << "the way by the speed is the least there is";
    EXPECT_LE(duration, 0.4 / speed + 2) << "and the ramps are short";
    before = duration;
  }
  before = 0;
  for (const double share : {1.0, 0.5, 0.25, 0.1}) {
    const ProgramPlan plan = plan_with({move_j(kSeed, share)});
    ASSERT_TRUE(plan.ok()) << told_of(plan);
    EXPECT_GT(plan.duration(), before);
    before = plan.duration();
  }
  // The speed of moves that name none is that of the options.
  const std::vector<Instruction> unnamed{move_j(a), move_l(b)};
  const ProgramPlan plain = plan_with(unnamed);
  EXPECT_NEAR(fastest(plain, plain.moves.back()), 0.25, 0.0025);
  const ProgramPlan slow = plan_with(unnamed, {.tool_speed = 0.05});
  EXPECT_NEAR(fastest(slow, slow.moves.back()), 0.05, 0.0005);
}

/// A speed by name is refused where a joint is too slow for it; the default one dips.
TEST(PlanInvariants, ASpeedBeyondTheJointsIsRefusedByNameAndTheDefaultDips) {
  const Pose a{{0.3, -0.45, 0.4}, kDown}, b{{-0.3, -0.45, 0.4}, kDown};
  const ProgramPlan named = plan_with({move_j(a), move_l(b, 5.0)});
  ASSERT_EQ(named.faults.size(), 1U);
  EXPECT_EQ(named.faults[0].reason, "joint_speed") << told_of(named);
  EXPECT_EQ(named.faults[0].code, Errc::impossible);
  // This lap comes near to the shoulder's singularity: one dip, and the figures of it are true.
  const DrawEllipse lap{.center = {0, -0.3, 0.5}, .a = 0.3, .b = 0.15, .R_FT = kDown};
  const ProgramPlan lowered = plan_with({{lap}});
  ASSERT_TRUE(lowered.ok()) << told_of(lowered);
  const PlannedMove& move = lowered.moves.back();
  expect_within_limits(move, 1);
  ASSERT_EQ(move.dips.size(), 1U);
  const SpeedDip& dip = move.dips[0];
  EXPECT_LT(dip.s_from, dip.s_least);
  EXPECT_LT(dip.s_least, dip.s_to);
  EXPECT_LE(dip.s_to, move.curve->end());
  constexpr double kStep = 1e-3, kAsked = 0.25;
  double least = kAsked;
  Vector3d before = fk(lowered.arms[0], as_span(move.trajectory.at(0).q)).p;
  for (double t = kStep; t < move.trajectory.duration(); t += kStep) {
    const Vector3d p = fk(lowered.arms[0], as_span(move.trajectory.at(t).q)).p;
    const double speed = (p - before).norm() / kStep;
    before = p;
    if (t > dip.t_from && t < dip.t_to) {
      least = std::min(least, speed);
    } else if (t > 1 && t < move.trajectory.duration() - 1) {
      ASSERT_NEAR(speed, kAsked, 0.005) << "outside of the dip, at " << t;
    }
  }
  EXPECT_NEAR(least, dip.least, 0.002);
}

/// Its timing fails while the paths of the moves after it are planned already.
TEST(PlanInvariants, AMoveThatCannotKeepItsSpeedEndsNoneButItself) {
  const Pose a{{0.3, -0.45, 0.4}, kDown}, b{{-0.3, -0.45, 0.4}, kDown}, c{{-0.3, -0.4, 0.4}, kDown};
  const Instruction fast = move_l(a, 5.0);
  const auto with = [&](const std::vector<Instruction>& some) {
    std::vector<Instruction> all{move_j(a), move_l(b)};
    all.insert(all.end(), some.begin(), some.end());
    return plan_with(all);
  };
  const ProgramPlan good = with({move_l(a), move_l(b), move_l(c)});
  ASSERT_TRUE(good.ok()) << told_of(good);
  const ProgramPlan plan = with({fast, move_l(b), move_l(c), fast});
  ASSERT_EQ(plan.faults.size(), 2U) << told_of(plan);
  for (const ProgramFault& fault : plan.faults) EXPECT_EQ(fault.reason, "joint_speed");
  // The moves of `good` but for the fast one.
  ASSERT_EQ(plan.moves.size(), good.moves.size() - 1);
  for (const auto& [one, same] : {std::pair{0, 0}, {1, 1}, {2, 3}, {3, 4}}) {
    const PlannedMove &move = plan.moves[static_cast<std::size_t>(one)],
                      &twin = good.moves[static_cast<std::size_t>(same)];
    EXPECT_EQ(move.trajectory.duration(), twin.trajectory.duration()) << one;
    EXPECT_LT((move.trajectory.at(0).q - twin.trajectory.at(0).q).norm(), 1e-9) << one;
    ASSERT_TRUE(move.measures && twin.measures) << one;
    EXPECT_EQ(move.measures->clearance, twin.measures->clearance) << one;
  }
}

TEST(PlanInvariants, ContactIsLookedAtOnlyWhereAsked) {
  const Pose above{{0, -0.45, 0.3}, kDown}, below{{0, -0.45, -0.1}, kDown};
  const std::vector<Instruction> through{move_j(kSeed), move_j(above), move_l(below)};
  const ProgramPlan looked = plan_with(through);
  ASSERT_EQ(looked.faults.size(), 1U) << told_of(looked);
  EXPECT_EQ(looked.faults[0].reason, "collision");
  EXPECT_THAT(looked.faults[0].what, ::testing::HasSubstr("floor"));
  const ProgramPlan blind = plan_with(through, {.collision = false});
  EXPECT_TRUE(blind.ok()) << told_of(blind);
  ASSERT_EQ(blind.moves.size(), 3U);
  EXPECT_TRUE(std::isinf(blind.moves.back().measures->clearance));
  EXPECT_LT((fk(blind.arms[0], as_span(blind.q_end())).p - below.p).norm(), 1e-6);
}

TEST(PlanInvariants, AStoppedPlanIsTheBeginningOfTheWholeOne) {
  const std::vector<Instruction> all{wait(0.1), move_j(kSeed), wait(0.2), move_j(kSeed, 0.5),
                                     wait(0.3)};
  const ProgramPlan whole = plan_with(all);
  for (std::size_t stop = 0; stop <= all.size(); ++stop) {
    std::vector<std::size_t> told;
    const ProgramPlan part = plan_with(all, {.after_step =
                                                 [&](std::size_t done, std::size_t total) {
                                                   told.push_back(done);
                                                   EXPECT_EQ(total, all.size());
                                                 },
                                             .stop = [&] { return told.size() > stop; }});
    EXPECT_EQ(part.ok(), stop >= all.size()) << "a part is no plan";
    ASSERT_EQ(part.moves.size(), std::min(stop, all.size()));
    EXPECT_TRUE(std::ranges::is_sorted(told));
    for (std::size_t i = 0; i < part.moves.size(); ++i) {
      EXPECT_EQ(part.moves[i].trajectory.duration(), whole.moves[i].trajectory.duration());
    }
  }
}

}  // namespace
}  // namespace mjarm::program
