#include "apps/bench/ik_hard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robots.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "mjarm/core/rng.hpp"

namespace mjarm::app {
namespace {

constexpr int kHardPoses = 300;
constexpr double kInside = 1e-3;  // [rad or m]

/// Joint values of one hard pose.
using Draw = JointVec (*)(const Arm& arm, Rng& rng);

bool coin(Rng& rng) { return rng.uniform() < 0.5; }

double zero_within(const Arm& arm, int i) {
  return std::clamp(0.0, arm.limits.lower[i], arm.limits.upper[i]);
}

/// `count` joints that have stops, or all of them, stand `inside` of one.
JointVec at_limits(const Arm& arm, int count, double inside, Rng& rng) {
  JointVec q = random_q(arm, rng);
  std::vector<int> joints;
  for (int i = 0; i < arm.dof(); ++i) {
    if (std::isfinite(arm.limits.upper[i] - arm.limits.lower[i])) joints.push_back(i);
  }
  for (; count > 0 && !joints.empty(); --count) {
    const auto at = static_cast<std::size_t>(rng.uniform() * static_cast<double>(joints.size()));
    const int i = joints[at];
    joints.erase(joints.begin() + static_cast<std::ptrdiff_t>(at));
    q[i] = coin(rng) ? arm.limits.upper[i] - inside : arm.limits.lower[i] + inside;
  }
  return q;
}

JointVec at_zero(const Arm& arm, Rng& rng) {
  JointVec q = random_q(arm, rng);
  for (int i = 0; i < arm.dof(); ++i) {
    if (coin(rng)) q[i] = zero_within(arm, i);
  }
  return q;
}

JointVec at_limits_or_zero(const Arm& arm, Rng& rng) {
  JointVec q = at_limits(arm, arm.dof(), 0, rng);
  for (int i = 0; i < arm.dof(); ++i) {
    if (rng.uniform() < 1.0 / 3) q[i] = zero_within(arm, i);
  }
  return q;
}

/// Why poses were not answered: "joint_limit 3, out_of_reach 1".
std::string causes_of(const IkRun& run) {
  std::map<std::string, int> causes;
  for (const std::size_t at : run.wrong) {
    if (at < run.reasons.size() && !run.reasons[at].empty()) ++causes[run.reasons[at]];
  }
  std::string out;
  for (const auto& [reason, count] : causes) {
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", reason, count);
  }
  return out.empty() ? "-" : out;
}

Result<BenchResult> measure_ik_hard(const BenchOptions& options, const std::string& robot,
                                    int rounds) {
  const auto seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  auto problem = load_ik_problem({.robot = robot, .tip = options.tip}, options.data, *seed);
  if (!problem) return fail(problem.error());
  auto sets = make_hard_sets(problem->robot, *seed);
  if (!sets) return fail(sets.error());
  problem->sets = std::move(*sets);
  const auto judge_run = [&](IkRun& run) -> Result<int> {
    const Result<int> wrong = judge_and_describe(*problem, run);
    if (!wrong || run.set == "fk_jacobian") return wrong;
    const int missed = static_cast<int>(run.wrong.size());
    run.cells = {count_of(run.right, run.q.size(), run.cases), std::to_string(missed - *wrong),
                 std::to_string(*wrong), causes_of(run)};
    return missed;
  };
  return compare(
      options.peers, {problem->name, problem->robot.model.file().filename().string()},
      run_ik_sets(*problem, rounds), [&] { return run_ik_peers(*problem, options.peers, rounds); },
      judge_run, msg::bench_ik_hard_wrong);
}

}  // namespace

Result<std::vector<IkCaseSet>> make_hard_sets(const Robot& robot, std::uint64_t seed) {
  const std::pair<const char*, Draw> kinds[] = {
      {"limit_1", [](const Arm& arm, Rng& rng) { return at_limits(arm, 1, 0, rng); }},
      {"limit_2", [](const Arm& arm, Rng& rng) { return at_limits(arm, 2, 0, rng); }},
      {"limit_3", [](const Arm& arm, Rng& rng) { return at_limits(arm, 3, 0, rng); }},
      {"inside_3", [](const Arm& arm, Rng& rng) { return at_limits(arm, 3, kInside, rng); }},
      {"zero", at_zero},
      {"limit_or_zero", at_limits_or_zero}};
  std::vector<IkCaseSet> sets;
  std::uint64_t stream = 5;  // after those of load_ik_problem()
  for (const auto& [name, draw] : kinds) {
    Rng rng(seed, stream++);
    IkCaseSet& set = sets.emplace_back(IkCaseSet{name, true, {}});
    for (int i = 0; i < kHardPoses; ++i) {
      const Result<Pose> X_WT = mujoco_pose(robot, as_span(draw(robot.arm, rng)));
      if (!X_WT) return fail(X_WT.error());
      const JointVec start = random_q(robot.arm, rng);
      set.cases.push_back({*X_WT, {start.begin(), start.end()}});
    }
  }
  return sets;
}

BenchVariant ik_hard_variant() {
  return {
      "--hard",
      msg::bench_ik_option_hard,
      {msg::bench_ik_right, msg::bench_ik_refused, msg::bench_ik_wrong_ones, msg::bench_ik_causes},
      measure_ik_hard};
}

}  // namespace mjarm::app
