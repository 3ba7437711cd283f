#include <algorithm>
#include <cmath>

#include "apps/bench/ik.hpp"
#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/kinematics/track.hpp"

namespace mjarm::app {
namespace {

/// Makes `run` the best of what it was and this call.
void keep(IkRun& run, std::size_t i, double us, const Result<IkSolution, IkFailure>& answer) {
  run.us[i] = std::min(run.us[i], us);
  run.q[i].clear();
  run.reasons[i].clear();
  if (answer) {
    run.q[i].assign(answer->q.begin(), answer->q.end());
  } else {
    run.reasons[i] = name(answer.error().code);
  }
}

IkRun empty_run(std::string who, std::string set, std::size_t count) {
  IkRun run{our_entry(std::move(who), std::move(set), count)};
  run.q.resize(count);
  run.reasons.resize(count);
  return run;
}

IkRun solve_set(const IkSolver& ik, std::string who, const IkCaseSet& set, int rounds,
                Progress& progress) {
  IkRun run = empty_run(std::move(who), set.name, set.cases.size());
  in_rounds(rounds, set.cases.size(), progress, [&](std::size_t i) {
    const Stopwatch watch;
    const auto answer = ik.solve(set.cases[i].X_WT, set.cases[i].seed);
    keep(run, i, watch.us(), answer);
  });
  return run;
}

/// What one pose of a path came to.
struct Followed {
  double us;                ///< [us] of the call
  JointVec q;               ///< where the arm stands then
  std::string reason = {};  ///< why it does not count as an answer
};

/// Every pose from the answer to the one before, by `follow(X_WT, q)`.
template <class Follow>
IkRun follow_paths(const IkProblem& problem, const char* set, int rounds, Progress& progress,
                   const Follow& follow) {
  std::size_t poses = 0;
  for (const std::vector<IkCase>& path : problem.paths) poses += path.size();
  IkRun run = empty_run("mjarm", set, poses);
  in_rounds(rounds, 1, progress, [&](std::size_t i) {
    for (const std::vector<IkCase>& path : problem.paths) {
      std::vector<double> q = path.front().seed;
      for (const IkCase& entry : path) {
        const Followed next = follow(entry.X_WT, q);
        run.max_step = std::max(run.max_step, (next.q - joint_vec(q)).cwiseAbs().maxCoeff());
        q.assign(next.q.begin(), next.q.end());
        run.us[i] = std::min(run.us[i], next.us);
        run.q[i] = next.reason.empty() ? q : std::vector<double>{};
        run.reasons[i] = next.reason;
        ++i;
      }
    }
  });
  return run;
}

/// By solving each pose.
Followed solve_pose(const IkSolver& ik, const Pose& X_WT, std::span<const double> q) {
  const Stopwatch watch;
  const auto answer = ik.solve(X_WT, q);
  const double us = watch.us();
  if (answer) return {us, answer->q};
  return {us, joint_vec(q), std::string(name(answer.error().code))};
}

/// By two servoing steps a pose, as a servo cycle is shorter than the way between poses; the time
/// is that of one step. Near a singularity steps are damped and fall behind, and tell so: no
/// answer.
Followed track_pose(const Tracker& tracker, const Pose& X_WT, std::span<const double> q) {
  const Stopwatch watch;
  const TrackStep first = tracker.step(X_WT, q);
  const TrackStep step = tracker.step(X_WT, as_span(first.q));
  const double us = 0.5 * watch.us();
  return {us, step.q, step.damping > 0 ? "damped" : ""};
}

/// One call after the other, as the loop of a controller makes them. All by one reading of the
/// clock, which takes as long as a call; the call goes through a table of functions, so that no
/// part of it is left out where its outputs are not all read.
IkRun run_jacobians(const IkProblem& problem, int rounds, Progress& progress) {
  const LinkChain chain{Chain(problem.robot.arm)};
  IkRun run{our_entry("mjarm", "fk_jacobian", 1)};
  double sum = 0;
  in_rounds(rounds, 1, progress, [&](std::size_t) {
    const Stopwatch watch;
    for (const std::vector<double>& q : problem.q) {
      const FkJacobian out = fk_jacobian(chain, q);
      sum += out.X_WT.p[0] + out.J_W(0, 0);
    }
    run.us[0] = std::min(run.us[0], watch.us() / static_cast<double>(problem.q.size()));
  });
  if (!std::isfinite(sum)) run.us.clear();
  return run;
}

/// The poses of a set in the order of its answers.
std::vector<const IkCase*> cases_of(const IkProblem& problem, const std::string& set) {
  std::vector<const IkCase*> cases;
  const auto add = [&](const std::vector<IkCase>& more) {
    for (const IkCase& entry : more) cases.push_back(&entry);
  };
  if (const IkCaseSet* known = set_named(problem.sets, set)) add(known->cases);
  if (set == "path" || set == "track") std::ranges::for_each(problem.paths, add);
  return cases;
}

}  // namespace

std::vector<IkRun> run_ik(const IkProblem& problem, int rounds) {
  const Arm& arm = problem.robot.arm;
  const IkSolver ik(arm);
  const IkSolver numeric(arm, {.closed_form = false});
  const Tracker tracker(arm, {.dt = 1});  // no bound on the speed: the poses have no time
  Progress progress(text(msg::bench_ik_progress, problem.name),
                    static_cast<std::size_t>(rounds) * (2 * problem.sets.size() + 3));
  std::vector<IkRun> runs;
  for (const IkCaseSet& set : problem.sets) {
    runs.push_back(solve_set(ik, "mjarm", set, rounds, progress));
    runs.push_back(solve_set(numeric, "mjarm numeric", set, rounds, progress));
  }
  runs.push_back(follow_paths(
      problem, "path", rounds, progress,
      [&](const Pose& X_WT, std::span<const double> q) { return solve_pose(ik, X_WT, q); }));
  runs.push_back(follow_paths(
      problem, "track", rounds, progress,
      [&](const Pose& X_WT, std::span<const double> q) { return track_pose(tracker, X_WT, q); }));
  runs.push_back(run_jacobians(problem, rounds, progress));
  return runs;
}

std::vector<IkRun> run_ik_sets(const IkProblem& problem, int rounds) {
  const IkSolver ik(problem.robot.arm);
  Progress progress(text(msg::bench_ik_progress, problem.name),
                    static_cast<std::size_t>(rounds) * problem.sets.size());
  std::vector<IkRun> runs;
  for (const IkCaseSet& set : problem.sets) {
    runs.push_back(solve_set(ik, "mjarm", set, rounds, progress));
  }
  return runs;
}

Result<void> judge(const IkProblem& problem, IkRun& run) {
  if (run.set == "fk_jacobian") return {};
  const IkCaseSet* const set = set_named(problem.sets, run.set);
  const bool reachable = set == nullptr || set->reachable;
  const std::vector<const IkCase*> cases = cases_of(problem, run.set);
  run.cases = cases.size();
  for (std::size_t i = 0; i < std::min(cases.size(), run.q.size()); ++i) {
    bool right = run.q[i].empty() && !reachable;
    if (!run.q[i].empty()) {
      // Whoever meets a pose that was thought out of reach is right: then the set is wrong.
      const Result<bool> fine = reaches(problem.robot, cases[i]->X_WT, run.q[i]);
      if (!fine) return fail(fine.error());
      right = *fine;
      run.false_ok += right ? 0 : 1;
    }
    if (right) {
      ++run.right;
    } else {
      run.wrong.push_back(i);
    }
  }
  return {};
}

}  // namespace mjarm::app
