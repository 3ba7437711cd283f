#include "apps/mjarm/commands/plan_robot.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/orientation.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/rule_options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/plan.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/planning/goal_region.hpp"
#include "mjarm/planning/plan_answer.hpp"
#include "mjarm/planning/planning_world.hpp"

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
  WorldOptions world;  ///< its rules are those of the words
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
  out.world.rules = std::move(*rules);
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

Result<PlannedPath, WorldFailure> find_way(PlanningWorld& world, const Way& way,
                                           const PlanOptions& options, PlanTimes& times) {
  if (way.tool) {
    return world.plan(way.start, way.tool->region, options, way.tool->task, &times);
  }
  return world.plan(way.start, std::vector{joint_vec(way.goal)}, options, &times);
}

/// Appends the answer as a JSON object.
void write_found(std::string& out, const Result<PlannedPath, WorldFailure>& found, const Way& way,
                 const PlanOptions& options, const PlanTimes& times, const WorldScene& scene,
                 bool timing) {
  PlanAnswer answer{.path = {}, .us = times.search_us, .simplify_us = times.finish_us};
  if (options.time_budget > 0) answer = {.path = {}, .us = times.search_us + times.finish_us};
  answer.tilt = options.tilt;
  answer.rules = way.words;
  if (found) {
    answer.path = *found;
  } else {
    answer.path = tl::unexpected(found.error().search);
  }
  append_answer(out, answer, scene.checker.robot(), scene.cover.scene, timing);
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
}

bool is_given(const RobotRequest& request) {
  const std::string* const words[] = {&request.robot.robot, &request.robot.tip, &request.start,
                                      &request.goal,        &request.pos,       &request.euler,
                                      &request.quat,        &request.task,      &request.within,
                                      &request.lean,        &request.turn,      &request.upright};
  return request.rules.any() ||
         std::ranges::any_of(words, [](const std::string* word) { return !word->empty(); });
}

Result<int> plan_for_robot(const RobotRequest& request, const PlanOptions& options,
                           const std::optional<session::PlanShow>& show, AnswerOutput& output,
                           bool timing) {
  RobotChoice choice = request.robot;
  choice.looks = show.has_value();
  const Result<Robot> robot = load_robot(choice);
  if (!robot) return fail(robot.error());
  const Result<Way> way = read_way(request, *robot);
  if (!way) return fail(way.error());
  PlanOptions how = options;
  if (Result<void> read = read_upright(request, robot->arm, *way, how); !read) {
    return fail(std::move(read.error()));
  }
  Result<PlanningWorld> world = PlanningWorld::create(*robot, way->world);
  if (!world) return fail(std::move(world.error()));
  PlanTimes times;
  const Result<PlannedPath, WorldFailure> found = find_way(*world, *way, how, times);
  if (interrupted()) return fail(stopped());
  const WorldErrc code = found ? WorldErrc::no_path : found.error().code;
  if (code == WorldErrc::bad_model) return fail(Errc::bad_input, found.error().what);
  const Result<const WorldScene*> scene = world->scene();
  if (!scene) return fail(scene.error());
  const std::string& name = robot->arm.name;
  std::string line;
  JsonWriter json(line);
  json.object().key(name);
  if (code == WorldErrc::no_answer) {
    json.object().member("ok", false).member("reason", found.error().what).end_object();
  } else {
    write_found(line, found, *way, how, times, **scene, timing);
  }
  json.end_object();
  const std::optional<std::string> why =
      found ? std::nullopt : std::optional<std::string>(found.error().what);
  const Result<int> exit_code = finish_one(output, line, why, msg::plan_no_path);
  if (!exit_code || !show || !found) return exit_code;
  const auto shown =
      session::show_plan(*show, {robot->model, robot->arm, (*scene)->checker, (*scene)->cover.scene,
                                 *found, name, way->world.rules});
  if (!shown) return fail(shown.error());
  return exit_code;
}

}  // namespace mjarm::app
