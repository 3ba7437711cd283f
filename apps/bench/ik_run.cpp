#include "apps/bench/ik_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/bench/robots.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/kinematics/link_chain.hpp"
#include "mjarm/kinematics/track.hpp"

namespace mjarm::app {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

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
  IkRun run{{.who = std::move(who), .set = std::move(set), .timed = "c++"}};
  run.us.assign(count, kNever);
  run.q.resize(count);
  run.reasons.resize(count);
  return run;
}

bool solve_set(const IkSolver& ik, const IkCaseSet& set, int rounds,
               const std::function<bool()>& advance, IkRun& run) {
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < set.cases.size(); ++i) {
      const Stopwatch watch;
      const auto answer = ik.solve(set.cases[i].X_WT, set.cases[i].seed);
      keep(run, i, watch.us(), answer);
    }
    if (!advance()) return false;
  }
  return true;
}

/// What one pose of a path came to.
struct Followed {
  double us;                ///< [us] of the call
  JointVec q;               ///< where the arm stands then
  std::string reason = {};  ///< why it does not count as an answer
};

/// Every pose from the answer to the one before, by `follow(X_WT, q)`.
template <class Follow>
bool follow_paths(const IkProblem& problem, int rounds, const std::function<bool()>& advance,
                  IkRun& run, const Follow& follow) {
  for (int round = 0; round < rounds; ++round) {
    std::size_t i = 0;
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
    if (!advance()) return false;
  }
  return true;
}

/// By solving each pose.
bool solve_paths(const IkSolver& ik, const IkProblem& problem, int rounds,
                 const std::function<bool()>& advance, IkRun& run) {
  return follow_paths(problem, rounds, advance, run, [&](const Pose& X_WT, std::span<double> q) {
    const Stopwatch watch;
    const auto answer = ik.solve(X_WT, q);
    const double us = watch.us();
    if (answer) return Followed{us, answer->q};
    return Followed{us, joint_vec(q), std::string(name(answer.error().code))};
  });
}

/// By two servoing steps a pose, as a servo cycle is shorter than the way between poses; the time
/// is that of one step. Near a singularity steps are damped and fall behind, and tell so: no
/// answer.
bool track_paths(const Arm& arm, const IkProblem& problem, int rounds,
                 const std::function<bool()>& advance, IkRun& run) {
  const Tracker tracker(arm, {.dt = 1});  // no bound on the speed: the poses have no time
  return follow_paths(problem, rounds, advance, run, [&](const Pose& X_WT, std::span<double> q) {
    const Stopwatch watch;
    const TrackStep first = tracker.step(X_WT, q);
    const TrackStep step = tracker.step(X_WT, as_span(first.q));
    const double us = 0.5 * watch.us();
    return Followed{us, step.q, step.damping > 0 ? "damped" : ""};
  });
}

/// One call after the other, as the loop of a controller makes them. All by one reading of the
/// clock, which takes as long as a call; the call goes through a table of functions, so that no
/// part of it is left out where its outputs are not all read.
bool run_jacobians(const IkProblem& problem, int rounds, const std::function<bool()>& advance,
                   IkRun& run) {
  const LinkChain chain{Chain(problem.robot.arm)};
  double sum = 0;
  for (int round = 0; round < rounds; ++round) {
    const Stopwatch watch;
    for (const std::vector<double>& q : problem.q) {
      const FkJacobian out = fk_jacobian(chain, q);
      sum += out.X_WT.p[0] + out.J_W(0, 0);
    }
    const double us = watch.us() / static_cast<double>(problem.q.size());
    run.us.assign(1, std::min(run.us.front(), us));
    if (!advance()) return false;
  }
  return std::isfinite(sum);
}

/// The poses of a set in the order of its answers.
std::vector<const IkCase*> cases_of(const IkProblem& problem, const std::string& set,
                                    bool& reachable) {
  std::vector<const IkCase*> cases;
  reachable = true;
  for (const IkCaseSet& known : problem.sets) {
    if (known.name != set) continue;
    reachable = known.reachable;
    for (const IkCase& entry : known.cases) cases.push_back(&entry);
  }
  if (set == "path" || set == "track") {
    for (const std::vector<IkCase>& path : problem.paths) {
      for (const IkCase& entry : path) cases.push_back(&entry);
    }
  }
  return cases;
}

}  // namespace

int ik_run_steps(const IkProblem& problem, int rounds) {
  return rounds * (2 * static_cast<int>(problem.sets.size()) + 3);
}

std::optional<std::vector<IkRun>> run_ik(const IkProblem& problem, int rounds,
                                         const std::function<bool()>& advance) {
  const Arm& arm = problem.robot.arm;
  std::vector<IkRun> runs;
  const IkSolver ik(arm);
  const IkSolver numeric(arm, {.closed_form = false});
  for (const IkCaseSet& set : problem.sets) {
    for (const IkSolver* solver : {&ik, &numeric}) {
      runs.push_back(
          empty_run(solver == &ik ? "mjarm" : "mjarm numeric", set.name, set.cases.size()));
      if (!solve_set(*solver, set, rounds, advance, runs.back())) return std::nullopt;
    }
  }
  std::size_t poses = 0;
  for (const std::vector<IkCase>& path : problem.paths) poses += path.size();
  runs.push_back(empty_run("mjarm", "path", poses));
  if (!solve_paths(ik, problem, rounds, advance, runs.back())) return std::nullopt;
  runs.push_back(empty_run("mjarm", "track", poses));
  if (!track_paths(arm, problem, rounds, advance, runs.back())) return std::nullopt;
  runs.push_back({{.who = "mjarm", .set = "fk_jacobian", .timed = "c++", .us = {kNever}}});
  if (!run_jacobians(problem, rounds, advance, runs.back())) return std::nullopt;
  return runs;
}

Result<void> judge(const IkProblem& problem, IkRun& run) {
  if (run.set == "fk_jacobian") return {};
  bool reachable = true;
  const std::vector<const IkCase*> cases = cases_of(problem, run.set, reachable);
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
