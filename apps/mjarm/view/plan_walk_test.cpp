#include "apps/mjarm/view/plan_walk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm::app {
namespace {

using State = PlanWalk::State;

constexpr double kTick = 0.002;  // [s]
constexpr double kMaxV = 2, kMaxA = 5, kMaxJ = 50;

JointVec two(double a, double b) { return joint_vec(std::vector{a, b}); }

PlannedMove joint_move(const JointVec& from, const JointVec& to) {
  JointLimits limits;
  limits.lower = two(-4, -4);
  limits.upper = two(4, 4);
  limits.velocity = two(kMaxV, kMaxV);
  limits.acceleration = two(kMaxA, kMaxA);
  limits.jerk = two(kMaxJ, kMaxJ);
  PlannedMove move;
  move.word = "movej";
  move.trajectory = time_joint_move(as_span(from), as_span(to), limits).value();
  return move;
}

/// Two joint moves with a gripper that closes between them.
ProgramPlan there_and_on() {
  ProgramPlan plan;
  plan.q_start = two(0, 0);
  plan.moves.push_back(joint_move(two(0, 0), two(1, -0.5)));
  PlannedMove grip = joint_move(two(1, -0.5), two(1, -0.5));
  grip.word = "grip";
  grip.close = true;
  plan.moves.push_back(std::move(grip));
  plan.moves.push_back(joint_move(two(1, -0.5), two(-0.3, 2)));
  return plan;
}

/// [rad] How far `q` is from the two straight ways of that plan.
double off_the_way(const JointVec& q) {
  const auto off = [&q](const JointVec& a, const JointVec& b) {
    const JointVec way = b - a;
    const double s = std::clamp((q - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    return (q - a - s * way).norm();
  };
  return std::min(off(two(0, 0), two(1, -0.5)), off(two(1, -0.5), two(-0.3, 2)));
}

int finish(PlanWalk& walk, std::vector<JointVec>* q = nullptr) {
  int steps = 0;
  while (walk.state() == State::running && steps < 100000) {
    const JointVec next = walk.next().reference.next;
    if (q != nullptr) q->push_back(next);
    ++steps;
  }
  return steps;
}

TEST(PlanWalk, GoesThroughTheTrajectoriesOnTheirOwnGrids) {
  const ProgramPlan plan = there_and_on();
  PlanWalk walk(plan, kTick);
  EXPECT_EQ(walk.state(), State::ready);
  EXPECT_EQ(walk.next().reference.next, plan.q_start);
  EXPECT_EQ(walk.state(), State::ready);
  walk.run();
  int closed = -1;
  int all = 0;
  for (const std::size_t i : {0U, 2U}) {
    const Trajectory& way = plan.moves[i].trajectory;
    const double end = way.duration() + (i == 2 ? 0.5 : 0);
    const int steps = static_cast<int>(std::ceil(end / kTick - 1e-9));
    for (int k = 1; k <= steps; ++k) {
      ASSERT_EQ(walk.state(), State::running) << i << " " << k;
      const PlanWalk::Step step = walk.next();
      EXPECT_EQ(step.begins, k == 1);
      if (step.close) closed = *step.close ? all : -2;
      ASSERT_EQ(step.reference.next, way.at(k * kTick).q) << i << " " << k;
      ASSERT_EQ(step.reference.now, way.at((k - 1) * kTick).q);
      ASSERT_EQ(step.reference.before, way.at((k - 2) * kTick).q);
      ++all;
    }
  }
  EXPECT_EQ(walk.state(), State::done);
  EXPECT_NEAR(walk.duration(), all * kTick, 1e-9);
  EXPECT_EQ(closed,
            static_cast<int>(std::ceil(plan.moves[0].trajectory.duration() / kTick - 1e-9)));
  walk.run();
  EXPECT_EQ(walk.state(), State::done);
  EXPECT_EQ(walk.next().reference.next, walk.q_ref());
}

TEST(PlanWalk, StopsWithinItsStepsAndStays) {
  const ProgramPlan plan = there_and_on();
  PlanWalk walk(plan, kTick);
  walk.run();
  for (int i = 0; i < 150; ++i) (void)walk.next();
  walk.stop();
  EXPECT_EQ(walk.state(), State::stopping);
  for (int i = 0; i < PlanWalk::kBrakeSteps; ++i) (void)walk.next();
  EXPECT_EQ(walk.state(), State::stopped);
  const JointVec q = walk.q_ref();
  EXPECT_GT(q[0], 0.05);
  EXPECT_LT(q[0], 0.95);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(walk.next().reference.next, q);
  EXPECT_LT(off_the_way(q), 1e-12);
}

/// Whatever the user does and when: the arm is on its way, and neither place nor speed jump. The
/// trajectory may ask for kMaxA; slowing its time down takes as much again as speed over time says
/// (three halves: the steepest place of the cubic).
TEST(PlanWalk, NeverJumps) {
  const ProgramPlan plan = there_and_on();
  const double max = kMaxA + 1.5 * kMaxV / (PlanWalk::kBrakeSteps * kTick);
  Rng rng(7);
  for (int trial = 0; trial < 60; ++trial) {
    PlanWalk walk(plan, kTick);
    JointVec before = plan.q_start, now = plan.q_start;
    int stops = 0;
    for (int i = 0; i < 20000 && walk.state() != State::done; ++i) {
      const double dice = rng.uniform(0, 1);
      if (dice < 0.004) walk.stop(), ++stops;
      if (dice > 0.99) walk.run();
      if (dice > 0.5 && dice < 0.503) walk.run_one();
      const JointVec q = walk.next().reference.next;
      ASSERT_LT(off_the_way(q), 1e-9);
      const JointVec a = (q - 2 * now + before) / (kTick * kTick);
      ASSERT_LT(a.cwiseAbs().maxCoeff(), max + 0.3) << trial << " " << i;
      before = now;
      now = q;
    }
    EXPECT_EQ(walk.state(), State::done) << trial;
    EXPECT_LT((now - two(-0.3, 2)).norm(), 1e-12);
    EXPECT_GT(stops, 0);
  }
}

TEST(PlanWalk, OneMotionAtATimeGoesTheSameWay) {
  const ProgramPlan plan = there_and_on();
  PlanWalk all(plan, kTick), singly(plan, kTick);
  std::vector<JointVec> q_all, q_singly;
  all.run();
  finish(all, &q_all);
  const State after[] = {State::stopped, State::stopped, State::done};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(singly.motion(), i);
    singly.run_one();
    if (i == 1) {  // takes no time
      EXPECT_EQ(singly.next().close, true);
    } else {
      finish(singly, &q_singly);
    }
    EXPECT_EQ(singly.state(), after[i]);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(singly.next().reference.next, singly.q_ref());
  }
  EXPECT_EQ(q_singly, q_all);
}

TEST(PlanWalk, StopBetweenMotionsAndRestart) {
  const ProgramPlan plan = there_and_on();
  PlanWalk walk(plan, kTick);
  walk.run();
  walk.stop();
  EXPECT_EQ(walk.state(), State::stopped);
  EXPECT_EQ(walk.next().reference.next, plan.q_start);
  walk.run();
  for (int i = 0; i < 100; ++i) (void)walk.next();
  walk.restart();
  EXPECT_EQ(walk.state(), State::ready);
  EXPECT_EQ(walk.motion(), 0U);
  EXPECT_EQ(walk.next().reference.before, plan.q_start);
}

TEST(PlanWalk, APlanWithoutMotionsIsDone) {
  ProgramPlan plan;
  plan.q_start = two(0.1, 0.2);
  PlanWalk walk(plan, kTick);
  EXPECT_EQ(walk.state(), State::done);
  walk.run();
  walk.run_one();
  walk.stop();
  EXPECT_EQ(walk.next().reference.next, plan.q_start);
  EXPECT_EQ(walk.duration(), 0);
}

}  // namespace
}  // namespace mjarm::app
