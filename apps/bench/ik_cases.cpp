#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/bench/ik.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr int kReachable = 1000;
constexpr int kUnreachable = 100;
constexpr int kCasePaths = 20;
constexpr int kPathPoses = 100;
constexpr double kPathStep = 0.01;  // [rad or m] largest joint step from pose to pose

std::vector<double> list(const JointVec& q) { return {q.begin(), q.end()}; }

IkCaseSet make_reachable(const Arm& arm, std::uint64_t seed) {
  IkCaseSet set{"reachable", true, {}};
  Rng rng(seed);
  for (int i = 0; i < kReachable; ++i) {
    const Pose X_WT = fk(arm, as_span(random_q(arm, rng)));
    set.cases.push_back({X_WT, list(random_q(arm, rng))});
  }
  return set;
}

/// Farther from the first joint than all links together are long.
IkCaseSet make_unreachable(const Arm& arm, std::uint64_t seed) {
  const double stretch = stretch_of(arm);
  IkCaseSet set{"unreachable", false, {}};
  if (!std::isfinite(stretch)) return set;
  Rng rng(seed, 1);
  for (int i = 0; i < kUnreachable; ++i) {
    Eigen::Vector3d direction(rng.normal(), rng.normal(), rng.normal());
    Pose X_WT = fk(arm, as_span(random_q(arm, rng)));
    X_WT.p = arm.joints.front().X_PJ.p + stretch * rng.uniform(1.01, 1.5) * direction.normalized();
    set.cases.push_back({X_WT, list(random_q(arm, rng))});
  }
  return set;
}

/// Tool poses along straight lines in joint space, which every arm can follow.
std::vector<std::vector<IkCase>> make_paths(const Arm& arm, std::uint64_t seed) {
  std::vector<std::vector<IkCase>> paths;
  Rng rng(seed, 2);
  for (int i = 0; i < kCasePaths; ++i) {
    const JointVec from = random_q(arm, rng);
    const JointVec way = random_q(arm, rng) - from;
    const double length = std::max(way.cwiseAbs().maxCoeff(), 1e-9);
    const double share = std::min(1.0, kPathPoses * kPathStep / length) / kPathPoses;
    std::vector<IkCase> path;
    for (int k = 1; k <= kPathPoses; ++k) {
      path.push_back({fk(arm, as_span(JointVec(from + share * k * way))), list(from)});
    }
    paths.push_back(std::move(path));
  }
  return paths;
}

Result<void> read_case_set(const fs::path& file, const Arm& arm, std::uint64_t seed,
                           IkCaseSet& set) {
  Rng rng(seed, 3);
  const auto take = [&](const JsonValue& object) -> Result<void> {
    const Result<Pose> X_WT = pose_of(object);
    if (!X_WT) return fail(X_WT.error());
    IkCase entry{*X_WT, list(random_q(arm, rng))};
    if (object.contains("seed")) {
      auto q_seed = number_list(object, "seed", static_cast<std::size_t>(arm.dof()));
      if (!q_seed) return fail(q_seed.error());
      entry.seed = std::move(*q_seed);
    }
    set.cases.push_back(std::move(entry));
    return {};
  };
  return read_cases(file, LineReader::kLongestLine, set.cases, take);
}

Result<std::vector<IkCaseSet>> read_case_sets(const fs::path& folder, const std::string& name,
                                              const Arm& arm, std::uint64_t seed) {
  std::vector<IkCaseSet> sets;
  for (const char* kind : {"reachable", "unreachable", "hard_negatives"}) {
    const fs::path file = folder / (name + "_" + kind + ".jsonl");
    if (!sets.empty() && !is_there(file)) continue;  // the first one must be there
    IkCaseSet& set = sets.emplace_back(IkCaseSet{kind, sets.empty(), {}});
    if (auto read = read_case_set(file, arm, seed, set); !read)
      return fail(std::move(read.error()));
  }
  return sets;
}

}  // namespace

Result<IkProblem> load_ik_problem(const RobotChoice& options, const fs::path& folder,
                                  std::uint64_t seed) {
  Result<Robot> robot = load_bench_robot(options, folder);
  if (!robot) return fail(std::move(robot.error()));
  IkProblem problem{fs::path(options.robot).stem().string(), std::move(*robot), {}, {}, {}};
  const Arm& arm = problem.robot.arm;
  if (folder.empty()) {
    problem.sets = {make_reachable(arm, seed), make_unreachable(arm, seed)};
  } else {
    Result<std::vector<IkCaseSet>> sets = read_case_sets(folder, problem.name, arm, seed);
    if (!sets) return fail(std::move(sets.error()));
    problem.sets = std::move(*sets);
  }
  Rng rng(seed, 4);
  for (int i = 0; i < kReachable; ++i) problem.q.push_back(list(random_q(arm, rng)));
  problem.paths = make_paths(arm, seed);
  return problem;
}

}  // namespace mjarm::app
