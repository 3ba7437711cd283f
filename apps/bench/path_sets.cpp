#include "apps/bench/path_sets.hpp"

#include <algorithm>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/path/curve.hpp"
#include "mjarm/path/path_request.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPathSeed = 1;
constexpr std::size_t kStarts = 10;
constexpr int kLines = 20;
constexpr int kPoses = 100;
constexpr int kTries = 2000;
constexpr std::size_t kLongestLine = std::size_t{1} << 26;  // [bytes] of a file of paths
constexpr double kSmooth = 0.1;  // [rad or m] largest step of a branch that counts as known

std::vector<Pose> poses_along(const Curve& line, int n) {
  std::vector<Pose> poses;
  for (int i = 0; i < n; ++i) poses.push_back(line.at(line.end() * i / (n - 1)));
  return poses;
}

/// True where the answers from `q` on follow one another in small steps.
bool followed(const IkSolver& ik, const std::vector<Pose>& poses, JointVec q) {
  return std::all_of(poses.begin(), poses.end(), [&](const Pose& X_WT) {
    const auto answer = ik.solve(X_WT, as_span(q));
    if (!answer || (answer->q - q).cwiseAbs().maxCoeff() > kSmooth) return false;
    q = answer->q;
    return true;
  });
}

/// Lines from a random pose, some 0.1 to 0.5 m long, that can be followed from there.
PathSet make_lines(const Arm& arm) {
  PathSet set{"lines", true, {}};
  const IkSolver ik(arm);
  Rng rng(kPathSeed);
  for (int i = 0; i < kTries && set.paths.size() < kLines; ++i) {
    const JointVec q = random_q(arm, rng);
    const Pose from = fk(arm, as_span(q));
    Pose to = from;
    to.p += rng.uniform(0.1, 0.5) *
            Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Result<Curve> line = Curve::line(from, to);
    if (!line) continue;
    std::vector<Pose> poses = poses_along(*line, kPoses);
    if (followed(ik, poses, q)) set.paths.push_back(std::move(poses));
  }
  return set;
}

/// The same lines, going on until no arm of that length can follow.
PathSet make_beyond(const Arm& arm, const PathSet& lines) {
  PathSet set{"beyond", false, {}};
  const double way = 2 * stretch_of(arm);
  for (const std::vector<Pose>& path : lines.paths) {
    Pose to = path.back();
    to.p += way * (to.p - path.front().p).normalized();
    if (const Result<Curve> line = Curve::line(path.front(), to)) {
      set.paths.push_back(poses_along(*line, 4 * kPoses));
    }
  }
  return set;
}

Result<void> read_path_set(const fs::path& file, const Arm& arm, PathSet& set) {
  const auto take = [&](const JsonValue& object) -> Result<void> {
    Result<PathRequest> request = path_request_of(object, arm);
    if (!request) return fail(std::move(request.error()));
    if (request->poses.empty()) return fail(Errc::bad_input, text(msg::bench_path_no_poses));
    set.paths.push_back(std::move(request->poses));
    return {};
  };
  return read_cases(file, kLongestLine, set.paths, take);
}

Result<std::vector<PathSet>> read_path_sets(const fs::path& folder, const std::string& name,
                                            const Arm& arm) {
  std::vector<PathSet> sets;
  for (const char* kind : {"lines", "ellipse_far", "ellipse"}) {
    const fs::path file = folder / (name + "_" + kind + ".jsonl");
    if (!is_there(file)) continue;
    PathSet& set = sets.emplace_back(PathSet{kind, std::string_view(kind) != "ellipse", {}});
    if (auto read = read_path_set(file, arm, set); !read) return fail(std::move(read.error()));
  }
  return sets;
}

}  // namespace

Result<PathProblem> load_path_problem(const RobotChoice& options, const fs::path& folder) {
  Result<Robot> robot = load_bench_robot(options, folder);
  if (!robot) return fail(std::move(robot.error()));
  PathProblem problem{fs::path(options.robot).stem().string(), std::move(*robot), {}, {}};
  const Arm& arm = problem.robot.arm;
  problem.seeds.emplace_back(arm.home.begin(), arm.home.end());
  Rng rng(kPathSeed, 1);
  while (problem.seeds.size() < kStarts) {
    const JointVec q = random_q(arm, rng);
    problem.seeds.emplace_back(q.begin(), q.end());
  }
  if (!folder.empty()) {
    Result<std::vector<PathSet>> sets = read_path_sets(folder, problem.name, arm);
    if (!sets) return fail(std::move(sets.error()));
    problem.sets = std::move(*sets);
  }
  if (problem.sets.empty()) {
    problem.sets = {make_lines(arm)};
    problem.sets.push_back(make_beyond(arm, problem.sets.front()));
    // No lines may be found for an odd arm, and one that slides without end is never out of reach.
    std::erase_if(problem.sets, [](const PathSet& set) { return set.paths.empty(); });
  }
  return problem;
}

}  // namespace mjarm::app
