#include <algorithm>
#include <cmath>

#include "apps/bench/time.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/trajectory/point_to_point.hpp"

namespace mjarm::app {
namespace {

constexpr double kStateTol = 1e-6;  // [rad, rad/s] at both ends
constexpr double kPassTol = 1e-3;   // [rad or m] at waypoints

constexpr double kRangeTol = 1e-9;  // [rad or m] beyond the range of a joint

/// Share of a limit that may be passed: path timers without jerk limits hold theirs on a grid.
double allowed(TimeProblem problem) { return problem == TimeProblem::path_va ? 1e-3 : 1e-6; }

bool same(const JointVec& a, const JointVec& b) {
  return (a - b).cwiseAbs().maxCoeff() <= kStateTol;
}

/// True where the motion comes near `point`: looked at more closely around its nearest sample.
bool passes(const Trajectory& motion, std::span<const JointState> states, const JointVec& point) {
  constexpr int kCloser = 100;
  const auto away = [&](const JointState& x) { return (x.q - point).cwiseAbs().maxCoeff(); };
  const auto nearest =
      std::min_element(states.begin(), states.end(),
                       [&](const auto& a, const auto& b) { return away(a) < away(b); });
  const double dt = motion.duration() / static_cast<double>(states.size() - 1);
  const double t = dt * static_cast<double>(nearest - states.begin());
  double least = away(*nearest);
  for (int k = -kCloser; k <= kCloser; ++k) {
    const double at = std::clamp(t + dt * k / kCloser, 0.0, motion.duration());
    least = std::min(least, away(motion.at(at)));
  }
  return least <= kPassTol;
}

bool arrives(const TimeSet& set, const TimeCase& entry, const Trajectory& motion,
             std::span<const JointState> states) {
  const JointState &first = states.front(), &last = states.back();
  if (set.problem == TimeProblem::p2p) {
    return same(first.q, entry.start.q) && same(first.v, entry.start.v) &&
           same(last.q, entry.end.q) && same(last.v, entry.end.v);
  }
  const JointVec still = JointVec::Zero(first.v.size());
  return same(first.q, entry.waypoints.front()) && same(last.q, entry.waypoints.back()) &&
         same(first.v, still) && same(last.v, still) &&
         std::all_of(entry.waypoints.begin(), entry.waypoints.end(),
                     [&](const JointVec& point) { return passes(motion, states, point); });
}

/// The motion that `at` gives, sampled and judged.
template <class At>
TimedMotion judged(const TimeSet& set, const TimeCase& entry, double duration, const At& at) {
  const int n = samples_of(set.problem);
  std::vector<JointState> states;
  for (int i = 0; i <= n; ++i) states.push_back(at(i == n ? duration : duration * i / n));
  return judge_motion(set, entry, duration, states);
}

/// How far beyond its range a joint gets between the samples, too: at the ends of each piece and
/// where its velocity v + a x + jerk x^2 / 2 is 0.
double outside(const PointToPoint& move, const JointLimits& limits) {
  double worst = 0;
  for (int i = 0; i < move.dof(); ++i) {
    const auto pieces = move.pieces(i);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const PointToPoint::Piece& p = pieces[k];
      const double h = (k + 1 < pieces.size() ? pieces[k + 1].t : move.duration()) - p.t;
      const double root = std::sqrt(std::max(0.0, p.a * p.a - 2 * p.jerk * p.v));
      for (const double x : {0.0, (root - p.a) / p.jerk, -(root + p.a) / p.jerk, -p.v / p.a, h}) {
        if (!(x >= 0 && x <= h)) continue;
        const double q = p.q + x * (p.v + x * (p.a / 2 + x * p.jerk / 6));
        worst = std::max({worst, q - limits.upper[i], limits.lower[i] - q});
      }
    }
  }
  return worst;
}

/// One case. Point to point is what a control loop calls; it makes no trajectory of its own.
TimedMotion solve(const TimeSet& set, const TimeCase& entry, bool judge, double& us) {
  const Stopwatch watch;
  if (set.problem == TimeProblem::p2p) {
    const auto move = PointToPoint::solve(entry.start, entry.end, set.limits);
    us = std::min(us, watch.us());
    if (!move) return {.reason = "bad_input"};
    if (!judge) return {};
    TimedMotion motion =
        judged(set, entry, move->duration(), [&](double t) { return move->at(t); });
    motion.outside = std::max(motion.outside, outside(*move, set.limits));
    motion.holds = motion.holds && motion.outside <= kRangeTol;
    return motion;
  }
  const Result<Trajectory> motion = time_case(entry, set.limits, set.problem);
  us = std::min(us, watch.us());
  if (!motion) return {.reason = motion.error().what};
  if (!judge) return {};
  return judged(set, entry, motion->duration(), [&](double t) { return motion->at(t); });
}

}  // namespace

int samples_of(TimeProblem problem) { return problem == TimeProblem::p2p ? 200 : 2000; }

TimedMotion judge_motion(const TimeSet& set, const TimeCase& entry, double duration,
                         std::span<const JointState> states) {
  TimedMotion out{.duration = duration};
  std::vector<double> times;
  const double dt = duration / static_cast<double>(states.size() - 1);
  for (std::size_t i = 0; i < states.size(); ++i) times.push_back(dt * static_cast<double>(i));
  const auto motion = Trajectory::through(times, {states.begin(), states.end()});
  if (!motion) return {.reason = motion.error().what};
  // A hair more than the interval, so that rounding makes no sample of its own at the end.
  const LimitUse use = check_limits(*motion, set.limits, dt * (1 + 1e-12));
  out.use = use.worst();
  if (set.problem != TimeProblem::path_va) out.use = std::max(out.use, use.jerk.maxCoeff());
  out.outside = std::max(0.0, use.position.maxCoeff());
  out.holds = out.use <= 1 + allowed(set.problem) && out.outside <= kRangeTol;
  out.arrives = arrives(set, entry, *motion, states);
  return out;
}

TimeRun run_time(const TimeSet& set, int rounds, Progress& progress) {
  TimeRun run{our_entry("mjarm", set.name, set.cases.size())};
  in_rounds(rounds, set.cases.size(), progress,
            [&](std::size_t i) { (void)solve(set, set.cases[i], false, run.us[i]); });
  for (const TimeCase& entry : set.cases) {
    if (interrupted()) break;
    double us = 0;  // of a call amid others: no measure
    run.motions.push_back(solve(set, entry, true, us));
  }
  return run;
}

}  // namespace mjarm::app
