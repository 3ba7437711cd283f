#pragma once

#include <stdexcept>
#include <utility>

#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/sim/worlds_test.hpp"

namespace mjarm::testing {

/// A motion from rest to rest in `seconds`.
inline Trajectory rest_to_rest(const JointVec& from, const JointVec& to, double seconds) {
  auto trajectory =
      Trajectory::through({0, seconds}, {JointState::at_rest(from), JointState::at_rest(to)});
  if (!trajectory) throw std::runtime_error(trajectory.error().what);
  return std::move(*trajectory);
}

inline JointVec shifted(const JointVec& q, double by) {
  return q + JointVec::Constant(q.size(), by);
}

/// Three motions from home: there, a moment that takes no time, and back half way.
inline MotionPlan there_and_half_back(const Arm& arm) {
  const JointVec home = arm.home, there = shifted(home, 0.3);
  MotionPlan plan = MotionPlan::of(arm, rest_to_rest(home, there, 0.6));
  plan.moves.front().word = "movej";
  plan.moves.push_back(
      {.word = "wait", .trajectory = *Trajectory::through({0.0}, {JointState::at_rest(there)})});
  plan.moves.push_back(
      {.word = "movej", .trajectory = rest_to_rest(there, shifted(home, 0.15), 0.4)});
  return plan;
}

}  // namespace mjarm::testing
