#include "apps/mjarm/learn/python_planner.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "apps/mjarm/learn/python_answer.hpp"
#include "apps/mjarm/messages/learn.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/planning/planning_world.hpp"
#include "mjarm/planning/verify_path.hpp"

namespace mjarm::app {
namespace {

using Rows = std::vector<std::vector<double>>;

constexpr const char* kWallScene = "universal_robots_ur5e/wall.xml";
constexpr double kPlanEnds = 1e-3;  // [rad, L2]

double joint_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

double length_of(const Rows& rows) {
  double length = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) length += joint_distance(rows[i - 1], rows[i]);
  return length;
}

/// What the reader's planner has to do, and what ours makes of it.
struct WallTask {
  Robot robot;
  std::vector<double> start, goal;
  double cost = 0;  // [rad] of our path
  std::size_t edges = 0;
};

Result<WallTask> wall_task() {
  Result<Robot> robot = load_robot({.robot = kWallScene, .looks = false});
  if (!robot) return fail(robot.error());
  WallTask task{std::move(*robot), {1.9084, -1.2456, 1.9905, -2.3157, -1.5708, 3.4792}, {}};
  Result<PlanningWorld> world = PlanningWorld::create(task.robot);
  if (!world) return fail(world.error());
  const Pose behind{{-0.3, -0.45, 0.2}, from_euler({std::numbers::pi, 0, 0})};
  const auto plan = world->plan(task.start, behind);
  if (!plan) return fail(Errc::impossible, plan.error().what);
  const JointVec& end = plan->q.back();
  task.goal.assign(end.begin(), end.end());
  task.cost = plan->cost;
  task.edges = plan->q.size() - 1;
  return task;
}

/// Why the value is no path; empty where it may be one.
std::string misshapen(const PythonCase& answer, std::size_t dof) {
  if (!answer.refused.empty()) return text(msg::learn_rrt_none, answer.refused);
  if (!answer.odd.empty()) return text(msg::learn_rrt_odd, answer.odd);
  if (answer.rows.size() < 2) return text(msg::learn_rrt_rows, answer.rows.size());
  for (std::size_t i = 0; i < answer.rows.size(); ++i) {
    if (answer.rows[i].size() == dof) continue;
    return text(msg::learn_rrt_row, i, answer.rows[i].size(), dof);
  }
  return {};
}

void judge_path(const WallTask& task, const PythonCase& answer, bool back, LearnReport& out) {
  const std::string way = text(back ? msg::learn_rrt_back : msg::learn_rrt_there);
  if (const std::string why = misshapen(answer, task.start.size()); !why.empty()) {
    out.wrong(way + why);
    return;
  }
  const Rows& rows = answer.rows;
  const double first = joint_distance(rows.front(), back ? task.goal : task.start);
  const double last = joint_distance(rows.back(), back ? task.start : task.goal);
  if (first > kPlanEnds) out.wrong(way + text(msg::learn_rrt_begins, first));
  if (last > kPlanEnds) out.wrong(way + text(msg::learn_rrt_ends, last));
  GivenPath path;
  path.id = "plan";
  path.rows = rows;
  const Result<PathVerdict> verdict = verify_path(task.robot, {}, path, {.stop = interrupted});
  if (!verdict) {
    out.wrong(way + verdict.error().what);
    return;
  }
  // MuJoCo finds the same place once more.
  if (!verdict->faults.empty()) out.wrong(way + verdict->faults.front().what);
  if (first > kPlanEnds || last > kPlanEnds || !verdict->faults.empty()) return;
  out.right(way + text(msg::learn_rrt_free, rows.size() - 1, length_of(rows)));
}

std::string case_line(const std::vector<double>& start, const std::vector<double>& goal) {
  return JsonDoc{{"start", start}, {"goal", goal}}.line();
}

}  // namespace

Result<LearnReport> check_python_planner(const Exercise& exercise) {
  const Result<WallTask> wall = wall_task();
  if (!wall) return fail(wall.error());
  const Result<std::vector<PythonCase>> answers = ask_python(
      exercise,
      {.function = "plan",
       .robot = kWallScene,
       .call = "function(robot, numpy.array(case[\"start\"]), numpy.array(case[\"goal\"]))",
       .cases = {case_line(wall->start, wall->goal), case_line(wall->goal, wall->start)}});
  if (!answers) return fail(answers.error());
  LearnReport out;
  judge_path(*wall, (*answers)[0], false, out);
  judge_path(*wall, (*answers)[1], true, out);
  if (out.wrong_count() > 0) out.note(text(msg::learn_rrt_between));
  out.note(text(msg::learn_rrt_ours, wall->edges, wall->cost));
  return out;
}

}  // namespace mjarm::app
