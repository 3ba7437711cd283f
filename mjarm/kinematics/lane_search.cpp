#include <algorithm>

#include "mjarm/kinematics/lane_search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr double kNearGoal = 1e-5;  // [rad^2] from here Newton's steps converge: descend() ends it
constexpr double kProgress = 0.5;   // the error must fall by this factor ...
constexpr int kPatience = 6;        // ... within so many steps, or the start is given up
constexpr double kSeedIsClose = 0.1;  // [rad^2] error from which a seed is waited for ...
constexpr int kSeedSteps = 4;         // ... for so many steps

}  // namespace

LaneSearch::LaneSearch(const Chain& chain, const Pose& X_WT, const DescentOptions& options,
                       const JointVec& seed, int starts, Rng& rng, Draw draw) noexcept
    : chain_(chain),
      goal_(X_WT),
      options_(options),
      seed_(seed),
      starts_(starts),
      rng_(rng),
      draw_(draw),
      kernel_(descent_kernel()) {
  for (int lane = 0; lane < kBlock; ++lane) fill(lane);
}

/// Puts the next start into a lane; without one the lane idles at the seed.
void LaneSearch::fill(int lane) noexcept {
  Lane& to = lanes_[lane];
  to.active = started_ < starts_;
  to.ended = false;
  to.near = false;
  to.steps = 0;
  to.start = started_;
  const JointVec q = to.active && started_ > 0 ? draw_(chain_, seed_, rng_) : seed_;
  if (to.active) ++started_;
  for (int i = 0; i < chain_.dof; ++i) block_.q[i][lane] = q[i];
}

std::optional<LaneDescentEnd> LaneSearch::next() noexcept {
  for (;;) {
    const int lane = pick();
    if (lane >= 0) return take(lane);
    const bool running =
        std::any_of(lanes_, lanes_ + kBlock, [](const Lane& l) { return l.active && !l.ended; });
    if (!running) return std::nullopt;
    step();
  }
}

/// A lane to hand out, or -1: the seed, then those near the goal, then those given up.
int LaneSearch::pick() noexcept {
  int near = -1;
  int given_up = -1;
  for (int lane = kBlock - 1; lane >= 0; --lane) {
    const Lane& l = lanes_[lane];
    if (!l.active || !l.ended) continue;
    if (l.start == 0) return lane;
    (l.near ? near : given_up) = lane;
  }
  if (near < 0) return given_up;
  const Lane& seed = lanes_[0];
  const bool wait = seed.active && seed.start == 0 && !seed.ended && seed.error < kSeedIsClose;
  if (wait && patience_ < kSeedSteps) {
    ++patience_;
    return -1;
  }
  return near;
}

void LaneSearch::step() noexcept {
  kernel_(chain_, goal_, options_, block_);
  for (int lane = 0; lane < kBlock; ++lane) {
    if (lanes_[lane].active && !lanes_[lane].ended) judge(lane);
  }
}

/// Looks at the error of a lane and decides whether it goes on.
void LaneSearch::judge(int lane) noexcept {
  Lane& l = lanes_[lane];
  l.error = block_.error[lane];
  if (l.steps == 0 || l.error < l.best_error) {
    l.best_error = l.error;
    l.best.resize(chain_.dof);
    for (int i = 0; i < chain_.dof; ++i) l.best[i] = block_.q[i][lane];
  }
  if (l.steps == 0 || l.best_error < kProgress * l.mark) {
    l.mark = l.best_error;
    l.since_mark = 0;
  } else {
    ++l.since_mark;
  }
  l.near = l.error < kNearGoal;
  l.ended = l.near || l.since_mark >= kPatience || l.steps >= options_.max_iterations;
  if (l.ended) return;
  ++l.steps;
  ++steps_;
  for (int i = 0; i < chain_.dof; ++i) block_.q[i][lane] = block_.next[i][lane];
}

/// Hands out the end of a lane and starts the next descent in it.
LaneDescentEnd LaneSearch::take(int lane) noexcept {
  Lane& l = lanes_[lane];
  LaneDescentEnd out;
  out.start = l.start;
  if (l.near) {
    out.descent = descend(chain_, goal_, l.best, options_);
    steps_ += out.descent.iterations;
  } else {
    out.descent.q = l.best;
    out.descent.error = l.best_error;
  }
  fill(lane);
  return out;
}

}  // namespace mjarm::detail
