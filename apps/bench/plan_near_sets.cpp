#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/plan_near.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/kinematics/chain.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAllRobots = 3;  // of near_robots(), Menagerie's included
constexpr std::size_t kScenesOfAKind = 2;
constexpr std::size_t kScenes = kNearKinds * kScenesOfAKind;  // of a robot
constexpr double kNearest = 1e-3;                             // [m]
constexpr double kFarthest = 0.02;                            // [m]
constexpr int kMaxScenes = 1000;                              // drawn until home is free
constexpr int kMaxGoals = 100'000;                            // drawn until one is as asked

/// [m] of the nearest thing; none where it is the floor or the arm itself that is nearest, or where
/// nothing is near.
std::optional<double> distance_of_thing(const CollisionReport& report) {
  if (!report.nearest) return std::nullopt;
  const GeomPair& pair = report.nearest->pair;
  if (!pair.geom1.starts_with("thing_") && !pair.geom2.starts_with("thing_")) return std::nullopt;
  return report.nearest->distance;
}

/// True where the links from the third on and the tool are above that height.
bool is_above(const Arm& arm, const JointVec& q, double level) {
  std::vector<Pose> X_WJ(arm.joints.size());
  const Pose X_WT = fk_all(arm, as_span(q), X_WJ);
  return X_WT.p.z() > level &&
         std::all_of(X_WJ.begin() + 2, X_WJ.end(), [&](const Pose& X) { return X.p.z() > level; });
}

ExactChecker near_checker(const Robot& robot) {
  return {robot.model, robot.arm, {.margin = kFarthest, .skip_neighbours = true}};
}

struct DrawnScene {
  NearScene scene;
  double level;
};

/// Things amid which the arm at home is free and no thing is near.
Result<DrawnScene> draw_scene(const NearRobot& robot, std::size_t index, Rng& rng) {
  const int kind = static_cast<int>(index) % kNearKinds;
  const fs::path file = robot.file.parent_path() / ("near_" + std::to_string(index) + ".xml");
  for (int tries = 0; tries < kMaxScenes; ++tries) {
    const NearThings things = draw_near_things(kind, rng);
    const std::string content = "<mujoco model=\"near\">\n<include file=\"" +
                                robot.file.filename().string() +
                                "\"/>\n<worldbody>\n"
                                "<geom name=\"floor\" type=\"plane\" size=\"0 0 0.05\"/>\n" +
                                things.geoms + "</worldbody>\n</mujoco>\n";
    if (auto written = write_file(file, content); !written) return fail(std::move(written.error()));
    Result<Robot> loaded =
        mjarm::load_robot(file.string(), {.tip = robot.tip, .load = {.trusted = true}});
    if (!loaded) return fail(std::move(loaded.error()));
    const auto report = near_checker(*loaded).check(as_span(loaded->arm.home));
    if (!report) return fail(report.error());
    if (!report->free || distance_of_thing(*report)) continue;
    return DrawnScene{{file, std::move(*loaded)}, things.level};
  }
  return fail(Errc::impossible,
              text(msg::bench_plan_near_no_room, robot.name, near_kind_name(kind)));
}

/// A goal near a thing.
Result<NearProblem> draw_goal(const DrawnScene& drawn, ExactChecker& checker, std::string id,
                              Rng& rng) {
  const Arm& arm = drawn.scene.robot.arm;
  for (int tries = 0; tries < kMaxGoals; ++tries) {
    const JointVec q = unwind(Chain(arm), random_q(arm, rng), arm.home);
    if (!is_above(arm, q, drawn.level)) continue;
    const auto report = checker.check(as_span(q));
    if (!report) return fail(report.error());
    if (!report->free || distance_of_thing(*report).value_or(0) < kNearest) continue;
    return NearProblem{.id = std::move(id), .start = arm.home, .goal = q};
  }
  return fail(Errc::impossible, text(msg::bench_plan_near_no_room, arm.name, id));
}

/// The problems of one scene, their poses included.
Result<void> draw_problems(const NearRobot& robot, std::size_t index, std::size_t count, Rng& rng,
                           NearSet& set) {
  Result<DrawnScene> drawn = draw_scene(robot, index, rng);
  if (!drawn) return fail(std::move(drawn.error()));
  ExactChecker checker = near_checker(drawn->scene.robot);
  const std::string name = near_kind_name(static_cast<int>(index) % kNearKinds) +
                           (" " + std::to_string(index / kNearKinds + 1));
  for (std::size_t i = 0; i < count; ++i) {
    auto problem = draw_goal(*drawn, checker, name + ", " + std::to_string(i + 1), rng);
    if (!problem) return fail(std::move(problem.error()));
    problem->scene = set.scenes.size();
    if (set.problems.size() % 2 == 1) {
      problem->X_WT = fk(drawn->scene.robot.arm, as_span(problem->goal));
    }
    set.problems.push_back(std::move(*problem));
  }
  set.scenes.push_back(std::move(drawn->scene));
  return {};
}

}  // namespace

Result<std::vector<NearSet>> draw_near_sets(const std::vector<NearRobot>& robots, int goals,
                                            std::uint64_t seed) {
  const auto all = static_cast<std::size_t>(goals);
  // Those of the first scenes, rounded up: the first goals are there whatever robots are left out.
  constexpr std::size_t kAll = kAllRobots * kScenes;
  const auto before = [&](std::size_t scene) { return (all * scene + kAll - 1) / kAll; };
  std::vector<NearSet> sets;
  for (std::size_t robot = 0; robot < robots.size(); ++robot) {
    NearSet set{robots[robot], {}, {}};
    for (std::size_t index = 0; index < kScenes; ++index) {
      const std::size_t scene = robot * kScenes + index;
      const std::size_t count = before(scene + 1) - before(scene);
      if (count == 0) continue;
      Rng rng(seed, scene);
      auto drawn = draw_problems(robots[robot], index, count, rng, set);
      if (!drawn) return fail(std::move(drawn.error()));
    }
    if (!set.problems.empty()) sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace mjarm::app
