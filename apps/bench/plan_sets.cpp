#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/plan.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/collision/fast_check.hpp"

namespace mjarm::app {
namespace {

constexpr int kPairs = 16;               // of start and goal
constexpr int kMaxTries = 100'000;       // for each pair and for each box
constexpr double kLeastHalf = 0.005;     // [m] half sides of boxes
constexpr double kMaxHalf = 0.015;       // [m]
constexpr double kRoom = 0.03;           // [m] left round the arm in all starts and goals
constexpr double kPointRadius = 0.0025;  // [m]
constexpr std::size_t kBoxes[] = {1, 10, 100, 1000};
constexpr std::size_t kPoints[] = {1000, 10'000, 100'000};

/// The file of a set; empty where the folder has none.
std::filesystem::path file_in(const std::filesystem::path& folder, const std::string& name) {
  for (const char* extension : {".json.gz", ".json"}) {
    std::filesystem::path file = folder / ("mbm_" + name + "_public" + extension);
    if (is_there(file)) return file;
  }
  return {};
}

Eigen::Vector3d random_direction(Rng& rng) {
  return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
}

/// Uniform in a ball round the first joint that no tool leaves.
Eigen::Vector3d random_place(const Arm& arm, Rng& rng) {
  const double reach = stretch_of(arm);
  return arm.joints.front().X_PJ.p + std::cbrt(rng.uniform()) * reach * random_direction(rng);
}

/// Configurations that the arm alone allows, one after another.
Result<std::vector<double>> free_configurations(const PlanSet& like, int count, Rng& rng) {
  const Result<FastChecker> checker = FastChecker::create(like.robot, {});
  if (!checker) return fail(checker.error());
  std::vector<double> rows;
  for (int i = 0; i < count; ++i) {
    JointVec q = random_q(like.arm, rng);
    for (int tries = 0; !checker->is_free(as_span(q)); ++tries) {
      if (tries == kMaxTries)
        return fail(Errc::impossible, text(msg::bench_plan_no_room, like.name));
      q = random_q(like.arm, rng);
    }
    rows.insert(rows.end(), q.data(), q.data() + q.size());
  }
  return rows;
}

/// True where the box leaves room to the arm in all these configurations.
Result<bool> leaves_room(const PlanSet& like, Obstacle box, const std::vector<double>& rows) {
  std::get<BoxShape>(box.shape).half.array() += kRoom;
  const Result<FastChecker> checker = FastChecker::create(like.robot, {.solids = {std::move(box)}});
  if (!checker) return fail(checker.error());
  std::vector<std::uint8_t> free(rows.size() / like.arm.joints.size());
  checker->check(rows, free);
  return std::find(free.begin(), free.end(), 0) == free.end();
}

Result<std::vector<Obstacle>> strewn_boxes(const PlanSet& like, std::size_t count,
                                           const std::vector<double>& rows, Rng& rng) {
  std::vector<Obstacle> boxes;
  for (int tries = 0; boxes.size() < count; ++tries) {
    if (tries == kMaxTries) return fail(Errc::impossible, text(msg::bench_plan_no_room, like.name));
    Obstacle box;
    box.X_WO = {random_place(like.arm, rng),
                Eigen::AngleAxisd(rng.uniform(0, 3), random_direction(rng)).toRotationMatrix()};
    const auto half = [&] { return rng.uniform(kLeastHalf, kMaxHalf); };
    box.shape = BoxShape{{half(), half(), half()}};
    const Result<bool> fits = leaves_room(like, box, rows);
    if (!fits) return fail(fits.error());
    if (*fits) boxes.push_back(std::move(box));
  }
  return boxes;
}

/// On a random side of a random box.
Eigen::Vector3d random_point(const std::vector<Obstacle>& boxes, Rng& rng) {
  const Obstacle& box = boxes[rng.below(boxes.size())];
  const Eigen::Vector3d half = std::get<BoxShape>(box.shape).half;
  Eigen::Vector3d p;
  for (Eigen::Index i = 0; i < 3; ++i) p[i] = rng.uniform(-half[i], half[i]);
  const auto axis = static_cast<Eigen::Index>(rng.below(3));
  p[axis] = rng.below(2) == 0 ? -half[axis] : half[axis];
  return box.X_WO * p;
}

PointCloud random_points(const std::vector<Obstacle>& boxes, std::size_t count, Rng& rng) {
  PointCloud cloud{.name = "points", .radius = kPointRadius};
  for (std::size_t i = 0; i < count; ++i) cloud.points_W.push_back(random_point(boxes, rng));
  return cloud;
}

CrowdedSet crowded(const PlanSet& like, const std::vector<double>& rows, std::size_t count,
                   bool points, const Obstacles& obstacles) {
  CrowdedSet crowd{count, points, {like.name, {}, like.arm, like.spheres, like.robot, {}}};
  const std::size_t dof = like.arm.joints.size();
  for (std::size_t at = 0; at < rows.size(); at += 2 * dof) {
    const std::span<const double> start(rows.data() + at, dof);
    const std::span<const double> goal(rows.data() + at + dof, dof);
    crowd.set.cases.push_back({std::to_string(at / (2 * dof)),
                               "",
                               {start.begin(), start.end()},
                               {joint_vec(goal)},
                               obstacles});
  }
  return crowd;
}

}  // namespace

Result<PlanSet> load_plan_set(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = file_in(folder, name);
  if (folder.empty() || file.empty()) {
    return fail(Errc::not_available,
                text(msg::bench_plan_no_data, name, folder.empty() ? "." : folder.string()));
  }
  Result<ProblemFile> content = read_problem_file(file.string());
  if (!content) return fail(std::move(content.error()));
  Result<FastRobot> robot = FastRobot::create(content->arm, content->spheres);
  if (!robot) return fail(std::move(robot.error()));
  PlanSet set{name, file, content->arm, content->spheres, std::move(*robot), {}};
  for (PlanProblem& problem : content->problems) {
    if (problem.valid && !problem.goals.empty()) set.cases.push_back(std::move(problem));
  }
  if (set.cases.empty()) return fail(no_cases(file));
  return set;
}

std::vector<PlanScene> scenes_of(const PlanSet& set) {
  std::vector<PlanScene> scenes;
  for (std::size_t i = 0; i < set.cases.size(); ++i) {
    const auto known = std::ranges::find(scenes, set.cases[i].scene, &PlanScene::name);
    PlanScene& scene =
        known != scenes.end() ? *known : scenes.emplace_back(PlanScene{set.cases[i].scene, {}});
    scene.problems.push_back(i);
  }
  return scenes;
}

Result<std::vector<CrowdedSet>> make_crowded_sets(const PlanSet& like, std::uint64_t seed) {
  Rng rng(seed);
  const auto rows = free_configurations(like, 2 * kPairs, rng);
  if (!rows) return fail(rows.error());
  const auto boxes = strewn_boxes(like, *std::rbegin(kBoxes), *rows, rng);
  if (!boxes) return fail(boxes.error());
  std::vector<CrowdedSet> sets;
  for (const std::size_t count : kBoxes) {
    const Obstacles some{.solids = {boxes->begin(), boxes->begin() + static_cast<int>(count)}};
    sets.push_back(crowded(like, *rows, count, false, some));
  }
  for (const std::size_t count : kPoints) {
    const Obstacles some{.clouds = {random_points(*boxes, count, rng)}};
    sets.push_back(crowded(like, *rows, count, true, some));
  }
  return sets;
}

}  // namespace mjarm::app
