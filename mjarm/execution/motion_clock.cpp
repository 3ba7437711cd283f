#include "mjarm/execution/motion_clock.hpp"

#include <algorithm>
#include <cmath>

namespace mjarm {
namespace {

constexpr double kHurry = 1.25;  // of the limits of jerk
constexpr int kBrakeStride = 5;  // of the numbers of steps that are tried
constexpr double kWhole = 1e-9;  // [steps] more than a whole number is rounding

}  // namespace

MotionClock::MotionClock(const MotionPlan& plan, double timestep, double rest_at_end)
    : plan_(&plan), timestep_(timestep), rest_at_end_(rest_at_end) {
  restart();
}

void MotionClock::restart() {
  motion_ = 0;
  at_ = 0;
  pace_ = 0;
  brake_ = kBrakeSteps;
  going_ = one_ = begun_ = false;
  before_ = now_ = plan_->q_start;
}

void MotionClock::run() { set_out(false); }
void MotionClock::run_one() { set_out(true); }

void MotionClock::set_out(bool one) {
  if (state() == State::done) return;
  going_ = begun_ = true;
  one_ = one;
  // Motions begin at rest: nothing has to be taken up.
  if (at_ == 0) pace_ = brake_;
}

void MotionClock::stop() {
  going_ = one_ = false;
  if (at_ == 0) pace_ = 0;
}

bool MotionClock::keeps(const JointLimits& limits, int brake) const {
  MotionClock tried = *this;
  tried.brake_ = tried.pace_ = brake;
  tried.stop();
  const double earlier = std::max(0.0, at_ - 2) * timestep_;
  JointVec q = now_, v = (now_ - before_) / timestep_;
  JointVec a =
      (v - (before_ - plan_->moves[motion_].trajectory.at(earlier).q) / timestep_) / timestep_;
  while (tried.is_moving()) {
    const JointVec next = tried.next().reference.next;
    const JointVec v_next = (next - q) / timestep_, a_next = (v_next - v) / timestep_;
    const JointVec jerk = (a_next - a) / timestep_;
    if ((a_next.cwiseAbs() - limits.acceleration).maxCoeff() > 0) return false;
    if ((jerk.cwiseAbs() - limits.jerk).maxCoeff() > 0) return false;
    q = next;
    v = v_next;
    a = a_next;
  }
  return true;
}

void MotionClock::brake(const JointLimits& limits) {
  if (pace_ == brake_) {
    // A motion that uses all of its jerk leaves none for brakes of any length.
    JointLimits hurried = limits;
    hurried.jerk *= kHurry;
    int steps = kBrakeSteps;
    for (const JointLimits* kept : {&limits, static_cast<const JointLimits*>(&hurried)}) {
      if (steps < kBrakeSteps) break;
      steps = kBrakeStride;
      while (steps < kBrakeSteps && !keeps(*kept, steps)) steps += kBrakeStride;
    }
    brake_ = pace_ = std::min(steps, kBrakeSteps);
  }
  stop();
}

bool MotionClock::is_moving() const noexcept {
  return motion_ < plan_->moves.size() && (going_ || pace_ > 0);
}

MotionClock::State MotionClock::state() const noexcept {
  if (motion_ == plan_->moves.size()) return State::done;
  if (going_) return State::running;
  if (pace_ > 0) return State::stopping;
  return begun_ ? State::stopped : State::ready;
}

double MotionClock::steps_of(std::size_t motion) const {
  const double rest = motion + 1 == plan_->moves.size() ? rest_at_end_ : 0;
  const PlannedMove& move = plan_->moves[motion];
  const double steps = (move.trajectory.duration() + rest) / timestep_;
  return move.passes ? steps : std::ceil(steps - kWhole);
}

double MotionClock::duration() const {
  double steps = 0;
  for (std::size_t i = 0; i < plan_->moves.size(); ++i) {
    steps += steps_of(i);
    if (!plan_->moves[i].passes) steps = std::ceil(steps - kWhole);
  }
  return steps * timestep_;
}

/// Passes what takes no time.
void MotionClock::begin_motion(Step& step) {
  while (is_moving() && at_ == 0) {
    const PlannedMove& move = plan_->moves[motion_];
    if (move.close) step.close = move.close;
    if (steps_of(motion_) > 0) {
      before_ = now_ = move.trajectory.at(0).q;
      step.begins = true;
      return;
    }
    end_motion();
  }
}

void MotionClock::end_motion() {
  ++motion_;
  at_ = 0;
  if (one_ || motion_ == plan_->moves.size()) going_ = one_ = false;
  pace_ = going_ ? brake_ : 0;
}

/// Goes over into the next motion where this one is passed, between two steps.
void MotionClock::pass_on(Step& step) {
  while (plan_->moves[motion_].passes && at_ > steps_of(motion_)) {
    at_ -= steps_of(motion_);
    ++motion_;
    step.begins = step.passes = true;
    step.motion = motion_;
  }
}

MotionClock::Step MotionClock::next() {
  Step step;
  begin_motion(step);
  step.motion = motion_;
  JointVec q = now_;
  step.moves = is_moving();
  if (step.moves) {
    pace_ = std::clamp(pace_ + (going_ ? 1 : -1), 0, brake_);
    const double share = static_cast<double>(pace_) / brake_;
    // The speed of time along a cubic: its own rate does not jump either.
    at_ += share * share * (3 - 2 * share);
    pass_on(step);
    at_ = std::min(at_, steps_of(motion_));
    q = plan_->moves[motion_].trajectory.at(at_ * timestep_).q;
  }
  step.reference = {before_, now_, q};
  before_ = now_;
  now_ = q;
  step.ends = step.moves && at_ == steps_of(motion_) && !plan_->moves[motion_].passes;
  if (step.ends) end_motion();
  return step;
}

}  // namespace mjarm
