#include "mjarm/execution/motion_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm {
namespace {

using State = MotionClock::State;

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
MotionPlan there_and_on() {
  MotionPlan plan;
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

int finish(MotionClock& clock, std::vector<JointVec>* q = nullptr) {
  int steps = 0;
  while (clock.state() == State::running && steps < 100000) {
    const JointVec next = clock.next().reference.next;
    if (q != nullptr) q->push_back(next);
    ++steps;
  }
  return steps;
}

TEST(MotionClock, GoesThroughTheTrajectoriesOnTheirOwnGrids) {
  const MotionPlan plan = there_and_on();
  MotionClock clock(plan, kTick);
  EXPECT_EQ(clock.state(), State::ready);
  EXPECT_EQ(clock.next().reference.next, plan.q_start);
  EXPECT_EQ(clock.state(), State::ready);
  clock.run();
  int closed = -1;
  int all = 0;
  for (const std::size_t i : {0U, 2U}) {
    const Trajectory& way = plan.moves[i].trajectory;
    const double end = way.duration() + (i == 2 ? 0.5 : 0);
    const int steps = static_cast<int>(std::ceil(end / kTick - 1e-9));
    for (int k = 1; k <= steps; ++k) {
      ASSERT_EQ(clock.state(), State::running) << i << " " << k;
      const MotionClock::Step step = clock.next();
      EXPECT_EQ(step.begins, k == 1);
      EXPECT_EQ(step.ends, k == steps);
      EXPECT_EQ(step.motion, i);
      if (step.close) closed = *step.close ? all : -2;
      ASSERT_EQ(step.reference.next, way.at(k * kTick).q) << i << " " << k;
      ASSERT_EQ(step.reference.now, way.at((k - 1) * kTick).q);
      ASSERT_EQ(step.reference.before, way.at((k - 2) * kTick).q);
      ++all;
    }
  }
  EXPECT_EQ(clock.state(), State::done);
  EXPECT_NEAR(clock.duration(), all * kTick, 1e-9);
  EXPECT_EQ(closed,
            static_cast<int>(std::ceil(plan.moves[0].trajectory.duration() / kTick - 1e-9)));
  clock.run();
  EXPECT_EQ(clock.state(), State::done);
  EXPECT_EQ(clock.next().reference.next, clock.q_ref());
}

TEST(MotionClock, StopsWithinItsStepsAndStays) {
  const MotionPlan plan = there_and_on();
  MotionClock clock(plan, kTick);
  clock.run();
  for (int i = 0; i < 150; ++i) (void)clock.next();
  clock.stop();
  EXPECT_EQ(clock.state(), State::stopping);
  for (int i = 0; i < MotionClock::kBrakeSteps; ++i) (void)clock.next();
  EXPECT_EQ(clock.state(), State::stopped);
  const JointVec q = clock.q_ref();
  EXPECT_GT(q[0], 0.05);
  EXPECT_LT(q[0], 0.95);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(clock.next().reference.next, q);
  EXPECT_LT(off_the_way(q), 1e-12);
}

/// Whatever the user does and when: the arm is on its way, and neither place nor speed jump. The
/// trajectory may ask for kMaxA; slowing its time down takes as much again as speed over time says
/// (three halves: the steepest place of the cubic).
TEST(MotionClock, NeverJumps) {
  const MotionPlan plan = there_and_on();
  const double max = kMaxA + 1.5 * kMaxV / (MotionClock::kBrakeSteps * kTick);
  Rng rng(7);
  for (int trial = 0; trial < 60; ++trial) {
    MotionClock clock(plan, kTick);
    JointVec before = plan.q_start, now = plan.q_start;
    int stops = 0;
    for (int i = 0; i < 20000 && clock.state() != State::done; ++i) {
      const double dice = rng.uniform(0, 1);
      if (dice < 0.004) clock.stop(), ++stops;
      if (dice > 0.99) clock.run();
      if (dice > 0.5 && dice < 0.503) clock.run_one();
      const JointVec q = clock.next().reference.next;
      ASSERT_LT(off_the_way(q), 1e-9);
      const JointVec a = (q - 2 * now + before) / (kTick * kTick);
      ASSERT_LT(a.cwiseAbs().maxCoeff(), max + 0.3) << trial << " " << i;
      before = now;
      now = q;
    }
    EXPECT_EQ(clock.state(), State::done) << trial;
    EXPECT_LT((now - two(-0.3, 2)).norm(), 1e-12);
    EXPECT_GT(stops, 0);
  }
}

TEST(MotionClock, OneMotionAtATimeGoesTheSameWay) {
  const MotionPlan plan = there_and_on();
  MotionClock all(plan, kTick), singly(plan, kTick);
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

TEST(MotionClock, StopBetweenMotionsAndRestart) {
  const MotionPlan plan = there_and_on();
  MotionClock clock(plan, kTick);
  clock.run();
  clock.stop();
  EXPECT_EQ(clock.state(), State::stopped);
  EXPECT_EQ(clock.next().reference.next, plan.q_start);
  clock.run();
  for (int i = 0; i < 100; ++i) (void)clock.next();
  clock.restart();
  EXPECT_EQ(clock.state(), State::ready);
  EXPECT_EQ(clock.motion(), 0U);
  EXPECT_EQ(clock.next().reference.before, plan.q_start);
}

TEST(MotionClock, APlanWithoutMotionsIsDone) {
  MotionPlan plan;
  plan.q_start = two(0.1, 0.2);
  MotionClock clock(plan, kTick);
  EXPECT_EQ(clock.state(), State::done);
  clock.run();
  clock.run_one();
  clock.stop();
  EXPECT_EQ(clock.next().reference.next, plan.q_start);
  EXPECT_EQ(clock.duration(), 0);
}

/// One swing in two motions, cut between two steps where it is fast, and a joint move after it.
MotionPlan passing() {
  const JointVec from = two(0, 0), middle = two(0.4, -0.3), to = two(1, -0.5);
  const JointState fast{middle, two(0.9, -0.5), two(0.3, 0.2)};
  MotionPlan plan = there_and_on();
  plan.moves.erase(plan.moves.begin());
  PlannedMove first = joint_move(from, from), second = first;
  first.trajectory = Trajectory::through({0, 0.7007}, {JointState::at_rest(from), fast}).value();
  first.passes = true;
  second.trajectory = Trajectory::through({0, 1.0}, {fast, JointState::at_rest(to)}).value();
  plan.moves.insert(plan.moves.begin(), {first, second});
  return plan;
}

/// [rad/s^2] of the reference, by its second differences: far more where its speed jumps.
double largest_acceleration(const std::vector<JointVec>& q) {
  double largest = 0;
  for (std::size_t i = 2; i < q.size(); ++i) {
    const JointVec a = (q[i] - 2 * q[i - 1] + q[i - 2]) / (kTick * kTick);
    largest = std::max(largest, a.cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(MotionClock, PassesIntoTheNextMotionWithoutAJump) {
  const MotionPlan plan = passing();
  MotionClock clock(plan, kTick, 0);
  clock.run();
  std::vector<JointVec> q{plan.q_start, plan.q_start};
  std::vector<std::size_t> begun, ended;
  int passed = 0;
  while (clock.state() == State::running) {
    const MotionClock::Step step = clock.next();
    q.push_back(step.reference.next);
    if (step.begins) begun.push_back(step.motion);
    if (step.ends) ended.push_back(step.motion);
    if (!step.passes) continue;
    ++passed;
    // 0.7007 s are 350.35 steps: this one is 0.65 steps into the second motion.
    EXPECT_EQ(step.motion, 1U);
    EXPECT_LT((q.back() - plan.moves[1].trajectory.at(0.65 * kTick).q).norm(), 1e-12);
  }
  EXPECT_EQ(passed, 1);
  EXPECT_EQ(begun, (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_EQ(ended, (std::vector<std::size_t>{1, 3}));
  EXPECT_LT(largest_acceleration(q), 20);
  const auto steps = static_cast<double>(q.size() - 2);
  EXPECT_NEAR(clock.duration(), steps * kTick, 1e-12);
}

TEST(MotionClock, OneMotionGoesOnWhereItPasses) {
  const MotionPlan plan = passing();
  MotionClock clock(plan, kTick, 0);
  clock.run_one();
  finish(clock);
  EXPECT_EQ(clock.motion(), 2U);
  EXPECT_LT((clock.q_ref() - two(1, -0.5)).norm(), 1e-12);
}

/// Wherever it is stopped, before, at or after the goal that is passed.
TEST(MotionClock, StopsAndGoesOnRoundAGoalThatIsPassed) {
  const MotionPlan plan = passing();
  for (int stop_after = 90; stop_after < 480; stop_after += 30) {
    MotionClock clock(plan, kTick, 0);
    std::vector<JointVec> q{plan.q_start, plan.q_start};
    clock.run();
    for (int i = 0; i < stop_after; ++i) q.push_back(clock.next().reference.next);
    clock.stop();
    for (int i = 0; i < 2 * MotionClock::kBrakeSteps; ++i) {
      q.push_back(clock.next().reference.next);
    }
    EXPECT_EQ(clock.state(), State::stopped);
    clock.run();
    finish(clock, &q);
    EXPECT_EQ(clock.state(), State::done);
    EXPECT_LT((q.back() - two(-0.3, 2)).norm(), 1e-12);
    EXPECT_LT(largest_acceleration(q), 30) << stop_after;
  }
}

}  // namespace
}  // namespace mjarm
