#include "apps/mjarm/commands/plan_robot.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/orientation.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/plan_answer.hpp"
#include "apps/mjarm/commands/robot_world.hpp"
#include "mjarm/core/messages/app.hpp"
#include "mjarm/core/messages/plan.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/planning/goal_region.hpp"

namespace mjarm::app {
namespace {

/// What the tool is to reach.
struct ToolGoal {
  GoalRegion region;
  IkTask task = IkTask::pose;
};

/// A request whose words were read.
struct Way {
  std::vector<double> start;
  std::vector<double> goal;      ///< joint values, or
  std::optional<ToolGoal> tool;  ///< a pose
  RuleWords words;
  ContactRules rules;          ///< of these
  std::vector<double> bounds;  ///< [m] of covers, to be tried one after the other
};

Result<double> angle_of(const char* option, const std::string& value) {
  if (value.empty()) return 0.0;
  const Result<double> angle = parse_quantity(value, Quantity::angle);
  if (!angle) return fail(in_option(option, angle.error()));
  return angle;
}

Result<ToolGoal> read_tool_goal(const RobotRequest& request) {
  ToolGoal out;
  const auto pos = parse_list("--pos", request.pos, Quantity::length, 3);
  if (!pos) return fail(pos.error());
  const Result<IkTask> task =
      request.task.empty() ? Result<IkTask>(IkTask::pose) : parse_task(request.task);
  if (!task) return fail(task.error());
  out.task = *task;
  GoalRegion& region = out.region;
  region.X_WR.p = {(*pos)[0], (*pos)[1], (*pos)[2]};
  if (out.task != IkTask::position || !(request.euler + request.quat).empty()) {
    const Result<Eigen::Matrix3d> R = parse_rotation(request.euler, request.quat);
    if (!R) return fail(R.error());
    region.X_WR.R = *R;
  }
  if (!request.within.empty()) {
    const auto half = parse_list("--within", request.within, Quantity::length, 3);
    if (!half) return fail(half.error());
    region.half = {(*half)[0], (*half)[1], (*half)[2]};
  }
  const Result<double> lean = angle_of("--lean", request.lean);
  if (!lean) return fail(lean.error());
  region.lean = *lean;
  const Result<double> turn = angle_of("--turn", request.turn);
  if (!turn) return fail(turn.error());
  region.turn = *turn;
  if (!is_sound(region)) return fail(Errc::usage, text(msg::plan_bad_region));
  return out;
}

Result<std::vector<double>> read_bounds(const std::string& value) {
  if (value.empty()) return std::vector<double>(std::begin(kCoverBounds), std::end(kCoverBounds));
  const Result<double> bound = parse_quantity(value, Quantity::length);
  if (!bound) return fail(in_option("--spheres", bound.error()));
  if (!(*bound >= kNarrowestSpheres && *bound <= kWidestSpheres)) {
    return fail(Errc::usage, text(msg::plan_bad_spheres, value));
  }
  return std::vector<double>{*bound};
}

/// What only makes sense with `--pos`.
Result<void> no_tool_options(const RobotRequest& request) {
  const std::pair<const char*, const std::string*> options[] = {
      {"--pos", &request.pos},   {"--euler", &request.euler},   {"--quat", &request.quat},
      {"--task", &request.task}, {"--within", &request.within}, {"--lean", &request.lean},
      {"--turn", &request.turn}};
  for (const auto& [name, value] : options) {
    if (!value->empty()) return fail(Errc::usage, text(msg::app_exclusive_options, "--goal", name));
  }
  return {};
}

Result<Way> read_way(const RobotRequest& request, const Robot& robot) {
  const Arm& arm = robot.arm;
  Way out;
  out.start.assign(arm.home.begin(), arm.home.end());
  if (!request.start.empty()) {
    Result<std::vector<double>> start = parse_joints("--start", request.start, arm);
    if (!start) return fail(std::move(start.error()));
    out.start = std::move(*start);
  }
  Result<ContactRules> rules = rules_of(request.rules, robot, out.start);
  if (!rules) return fail(std::move(rules.error()));
  out.rules = std::move(*rules);
  out.words = request.rules;
  if (request.goal.empty() && request.pos.empty()) {
    return fail(Errc::usage, text(msg::app_need_one_of, "--goal", "--pos"));
  }
  if (!request.goal.empty()) {
    if (Result<void> none = no_tool_options(request); !none) return fail(std::move(none.error()));
    Result<std::vector<double>> goal = parse_joints("--goal", request.goal, arm);
    if (!goal) return fail(std::move(goal.error()));
    out.goal = std::move(*goal);
  } else {
    const Result<ToolGoal> tool = read_tool_goal(request);
    if (!tool) return fail(tool.error());
    out.tool = *tool;
  }
  Result<std::vector<double>> bounds = read_bounds(request.spheres);
  if (!bounds) return fail(std::move(bounds.error()));
  out.bounds = std::move(*bounds);
  return out;
}

/// Puts the limit of the tilt into the options.
Result<void> read_upright(const RobotRequest& request, const Arm& arm, const Way& way,
                          PlanOptions& options) {
  if (request.upright.empty()) return {};
  if (options.planner == Planner::ompl) {
    return fail(Errc::usage, text(msg::planning_tilt_with_ompl));
  }
  if (way.tool && way.tool->task == IkTask::position) {
    return fail(Errc::usage, text(msg::plan_upright_position));
  }
  const Result<double> max = angle_of("--keep-upright", request.upright);
  if (!max) return fail(max.error());
  options.tilt = keep_upright(arm, way.start, *max);
  if (is_sound(*options.tilt)) return {};
  return fail(Errc::usage, text(msg::plan_bad_upright, request.upright));
}

/// Rows of joint values; or why the pose has none.
Result<std::vector<double>, std::string> goals_of(const Way& way, const Arm& arm,
                                                  const FastChecker& checker,
                                                  const PlanOptions& options) {
  if (!way.tool) return way.goal;
  const IkSolver ik(arm, {.rng_seed = options.seed, .task = way.tool->task});
  const auto goals = goals_in(checker, ik, way.tool->region, way.start,
                              {.seed = options.seed, .tilt = options.tilt});
  if (!goals) return tl::unexpected(describe(goals.error(), arm));
  std::vector<double> rows;
  for (const JointVec& q : *goals) rows.insert(rows.end(), q.begin(), q.end());
  return rows;
}

/// Whether finer spheres may do better.
bool is_coarse(PlanErrc reason) {
  return reason == PlanErrc::start_hit || reason == PlanErrc::goals_hit ||
         reason == PlanErrc::goals_tilted || reason == PlanErrc::base_hit ||
         reason == PlanErrc::budget_spent;
}

/// An answer, and the world it was found in.
struct Found {
  std::string line;                ///< JSON
  std::optional<std::string> why;  ///< there is no path
  std::optional<RobotWorld> world = {};
  std::optional<PlannedPath> path = {};
};

Found not_found(const std::string& why) {
  Found out{"{\"ok\":false,\"reason\":", why};
  append_json_string(out.line, why);
  out.line += '}';
  return out;
}

/// Tries one cover after the other, until there is a path or finer spheres are no help.
Result<Found> answer(const Robot& robot, const Way& way, const PlanOptions& options, bool timing) {
  Found out;
  for (const double bound : way.bounds) {
    Result<RobotWorld> world = cover_robot(robot, bound, way.rules);
    if (!world) return fail(std::move(world.error()));
    const FastRobot& fast = world->checker.robot();
    Result<std::vector<double>, std::string> goals =
        goals_of(way, robot.arm, world->checker, options);
    if (!goals) return not_found(goals.error());
    PlanProblem problem;
    problem.start = way.start;
    problem.goals = std::move(*goals);
    problem.obstacles = world->cover.scene;
    PlanAnswer found = answer_problem(fast, problem, options);
    found.rules = way.words;
    found.spheres = bound;
    out = {};
    append_answer(out.line, found, fast, problem.obstacles, timing);
    if (!found.path) out.why = describe(found.path.error(), fast, problem.obstacles);
    const bool is_last = found.path || !is_coarse(found.path.error().reason);
    out.world = std::move(*world);
    if (found.path) out.path = std::move(*found.path);
    if (is_last) break;
  }
  return out;
}

}  // namespace

void add_robot_request(CLI::App& app, RobotRequest& request) {
  add_robot_options(app, request.robot);
  add_option(app, "--start", request.start, msg::plan_option_start, "Q1,Q2,...");
  add_option(app, "--goal", request.goal, msg::plan_option_goal, "Q1,Q2,...");
  add_option(app, "--pos", request.pos, msg::plan_option_pos, "X,Y,Z");
  add_option(app, "--euler", request.euler, msg::app_option_euler, "A,B,C");
  add_option(app, "--quat", request.quat, msg::app_option_quat, "W,X,Y,Z");
  add_option(app, "--task", request.task, msg::app_option_task, "TASK");
  add_option(app, "--within", request.within, msg::plan_option_within, "X,Y,Z");
  add_option(app, "--lean", request.lean, msg::plan_option_lean, "ANGLE");
  add_option(app, "--turn", request.turn, msg::plan_option_turn, "ANGLE");
  add_option(app, "--keep-upright", request.upright, msg::plan_option_upright, "ANGLE");
  add_rule_options(app, request.rules);
  add_option(app, "--spheres", request.spheres, msg::plan_option_spheres, "M");
}

bool is_given(const RobotRequest& request) {
  const std::string* const words[] = {
      &request.robot.robot, &request.robot.tip, &request.start,  &request.goal,   &request.pos,
      &request.euler,       &request.quat,      &request.task,   &request.within, &request.lean,
      &request.turn,        &request.upright,   &request.spheres};
  return request.rules.any() ||
         std::ranges::any_of(words, [](const std::string* word) { return !word->empty(); });
}

Result<int> plan_for_robot(const RobotRequest& request, const PlanOptions& options,
                           const std::optional<PlanShow>& show, const std::string& out,
                           bool timing) {
  const Result<Robot> robot = load_robot(request.robot);
  if (!robot) return fail(robot.error());
  const Result<Way> way = read_way(request, *robot);
  if (!way) return fail(way.error());
  PlanOptions how = options;
  if (Result<void> read = read_upright(request, robot->arm, *way, how); !read) {
    return fail(std::move(read.error()));
  }
  const Result<Found> found = answer(*robot, *way, how, timing);
  if (!found) return fail(found.error());
  const std::string& name = robot->arm.name;
  std::string line = "{";
  append_json_string(line, name);
  line += ':' + found->line + '}';
  const Result<int> code = finish_one(out, line, found->why, msg::plan_no_path);
  if (!code || !show || !found->path) return code;
  const auto shown =
      show_plan(*show, {robot->model, robot->arm, found->world->checker, found->world->cover.scene,
                        *found->path, name, way->rules.held});
  if (!shown) return fail(shown.error());
  return code;
}

}  // namespace mjarm::app
