#include "apps/mjarm/commands/plan_robot.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/orientation.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/plan_progress.hpp"
#include "apps/mjarm/commands/region_option.hpp"
#include "apps/mjarm/commands/rule_options.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "apps/mjarm/messages/plan.hpp"
#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/plan_answer.hpp"
#include "mjarm/planning/planning_world.hpp"

namespace mjarm::app {
namespace {

/// A request whose words were read.
struct Way {
  PathEnd start, goal;
  RuleWords words;
  WorldOptions world;  ///< its rules are those of the words
};

Result<double> angle_of(const char* option, const std::string& value) {
  if (value.empty()) return 0.0;
  const Result<double> angle = parse_quantity(value, Quantity::angle);
  if (!angle) return fail(in_option(option, angle.error()));
  return angle;
}

Result<PathEnd> read_tool_goal(const RobotRequest& request) {
  PathEnd out;
  const auto pos = parse_list("--pos", request.pos, Quantity::length, 3);
  if (!pos) return fail(pos.error());
  const Result<IkTask> task =
      request.task.empty() ? Result<IkTask>(IkTask::pose) : parse_task(request.task);
  if (!task) return fail(task.error());
  out.task = *task;
  Pose X_WT{{(*pos)[0], (*pos)[1], (*pos)[2]}, Eigen::Matrix3d::Identity()};
  if (out.task != IkTask::position || !(request.euler + request.quat).empty()) {
    const Result<Eigen::Matrix3d> R = parse_rotation(request.euler, request.quat);
    if (!R) return fail(R.error());
    X_WT.R = *R;
  }
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  if (!request.around.empty()) {
    const auto given = parse_list("--within", request.around, Quantity::length, 3);
    if (!given) return fail(given.error());
    half = {(*given)[0], (*given)[1], (*given)[2]};
  }
  const Result<double> lean = angle_of("--lean", request.lean);
  if (!lean) return fail(lean.error());
  const Result<double> turn = angle_of("--turn", request.turn);
  if (!turn) return fail(turn.error());
  out.regions.push_back(region_about(X_WT, half, *lean, *turn));
  const bool is_turn = *turn >= 0 && *turn <= kFreeTurn * (1 + 1e-9);
  if (!is_sound(out.regions.front()) || !is_turn) {
    return fail(Errc::usage, text(msg::plan_bad_region));
  }
  return out;
}

/// What only makes sense with `--pos`.
/// @param given  what was given instead.
Result<void> no_tool_options(const char* given, const RobotRequest& request) {
  const std::pair<const char*, const std::string*> options[] = {
      {"--pos", &request.pos},   {"--euler", &request.euler},   {"--quat", &request.quat},
      {"--task", &request.task}, {"--within", &request.around}, {"--lean", &request.lean},
      {"--turn", &request.turn}};
  for (const auto& [name, value] : options) {
    if (!value->empty()) return fail(Errc::usage, text(msg::app_exclusive_options, given, name));
  }
  return {};
}

/// @param X_WT  the tool at the only start; none: there are several.
Result<std::vector<TaskRegion>> read_regions(const char* option,
                                             const std::vector<std::string>& words,
                                             const Robot& robot, const std::optional<Pose>& X_WT) {
  std::vector<TaskRegion> out;
  for (const std::string& region : words) {
    const auto read = parse_region(option, region, Unnamed::fixed, robot, X_WT);
    if (!read) return fail(read.error());
    out.push_back(*read);
  }
  return out;
}

/// @param X_WT  as above.
Result<PathEnd> read_goal(const RobotRequest& request, const Robot& robot,
                          const std::optional<Pose>& X_WT) {
  const bool regions = !request.goal_regions.empty();
  if (request.goal.empty() && request.pos.empty() && !regions) {
    return fail(Errc::usage, text(msg::app_need_one_of, "--goal, --pos", "--goal-region"));
  }
  if (request.goal.empty() && !regions) return read_tool_goal(request);
  const char* const given = regions ? "--goal-region" : "--goal";
  if (auto none = no_tool_options(given, request); !none) return fail(std::move(none.error()));
  PathEnd out;
  if (regions && !request.goal.empty()) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--goal", given));
  }
  if (regions) {
    auto read = read_regions(given, request.goal_regions, robot, X_WT);
    if (!read) return fail(std::move(read.error()));
    out.regions = std::move(*read);
    return out;
  }
  const auto goal = parse_joints("--goal", request.goal, robot.arm);
  if (!goal) return fail(goal.error());
  out.q = {joint_vec(*goal)};
  return out;
}

/// What needs one start.
Result<void> no_start_options(const RobotRequest& request) {
  const std::pair<const char*, bool> options[] = {{"--start", !request.start.empty()},
                                                  {"--hold", !request.rules.hold.empty()},
                                                  {"--keep-upright", !request.upright.empty()}};
  for (const auto& [name, is_given] : options) {
    if (!is_given) continue;
    return fail(Errc::usage, text(msg::app_exclusive_options, "--start-region", name));
  }
  return {};
}

Result<PathEnd> read_start(const RobotRequest& request, const Robot& robot) {
  PathEnd out;
  if (!request.start_regions.empty()) {
    if (auto none = no_start_options(request); !none) return fail(std::move(none.error()));
    auto read = read_regions("--start-region", request.start_regions, robot, std::nullopt);
    if (!read) return fail(std::move(read.error()));
    out.regions = std::move(*read);
    return out;
  }
  out.q = {robot.arm.home};
  if (request.start.empty()) return out;
  const auto start = parse_joints("--start", request.start, robot.arm);
  if (!start) return fail(start.error());
  out.q = {joint_vec(*start)};
  return out;
}

/// The tool at the start, where there is only one.
std::optional<Pose> tool_at_start(const Way& way, const Arm& arm) {
  if (way.start.q.empty()) return std::nullopt;
  return fk(arm, as_span(way.start.q.front()));
}

Result<Way> read_way(const RobotRequest& request, const Robot& robot) {
  Way out;
  Result<PathEnd> start = read_start(request, robot);
  if (!start) return fail(std::move(start.error()));
  out.start = std::move(*start);
  const JointVec& reference = out.start.q.empty() ? robot.arm.home : out.start.q.front();
  Result<ContactRules> rules = rules_of(request.rules, robot, as_span(reference));
  if (!rules) return fail(std::move(rules.error()));
  out.world.rules = std::move(*rules);
  out.words = request.rules;
  Result<PathEnd> goal = read_goal(request, robot, tool_at_start(out, robot.arm));
  if (!goal) return fail(std::move(goal.error()));
  out.goal = std::move(*goal);
  return out;
}

/// Puts what the tool keeps on its way into the options.
Result<void> read_limits(const RobotRequest& request, const Robot& robot, const Way& way,
                         PlanOptions& options) {
  if (request.upright.empty() && request.within.empty()) return {};
  if (options.planner == Planner::ompl) {
    return fail(Errc::usage, text(msg::planning_tilt_with_ompl));
  }
  if (!request.within.empty()) {
    const auto region = parse_region("--keep-within", request.within, Unnamed::free, robot,
                                     tool_at_start(way, robot.arm));
    if (!region) return fail(region.error());
    if (!can_be_kept(*region)) {
      return fail(in_option(
          "--keep-within",
          {Errc::usage, text(msg::planning_bad_region, 1e3 * kLeastPlaceRange, kLeastTurnRange)}));
    }
    options.within = *region;
  }
  if (request.upright.empty()) return {};
  if (!way.goal.regions.empty() && way.goal.task == IkTask::position) {
    return fail(Errc::usage, text(msg::plan_upright_position));
  }
  const Result<double> max = angle_of("--keep-upright", request.upright);
  if (!max) return fail(max.error());
  options.tilt = keep_upright(robot.arm, as_span(way.start.q.front()), *max);
  if (is_sound(*options.tilt)) return {};
  return fail(Errc::usage, text(msg::plan_bad_upright, request.upright));
}

Result<PlannedPath, WorldFailure> find_way(PlanningWorld& world, const Way& way,
                                           const PlanOptions& options, PlanTimes& times) {
  PlanOptions told = options;
  const PlanProgress progress(told);
  if (way.start.regions.empty() && way.goal.regions.empty()) {
    return world.plan(as_span(way.start.q.front()), way.goal.q, told, &times);
  }
  return world.plan(way.start, way.goal, told, &times);
}

/// Appends the answer as a JSON object.
void write_found(std::string& out, const Result<PlannedPath, WorldFailure>& found, const Way& way,
                 const PlanOptions& options, const PlanTimes& times, const WorldScene& scene,
                 bool timing) {
  PlanAnswer answer{.path = {}, .us = times.search_us, .simplify_us = times.finish_us};
  if (options.time_budget > 0) answer = {.path = {}, .us = times.search_us + times.finish_us};
  answer.tilt = options.tilt;
  answer.within = options.within;
  answer.rules = way.words;
  if (found) {
    answer.path = *found;
  } else {
    answer.path = tl::unexpected(found.error().search);
    answer.reason = found.error().what;
    answer.same_posture = found.error().same_posture;
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
  add_option(app, "--within", request.around, msg::plan_option_within, "X,Y,Z");
  add_option(app, "--lean", request.lean, msg::plan_option_lean, "ANGLE");
  add_option(app, "--turn", request.turn, msg::plan_option_turn, "ANGLE");
  add_option(app, "--goal-region", request.goal_regions, msg::plan_option_goal_region, "REGION");
  add_option(app, "--start-region", request.start_regions, msg::plan_option_start_region, "REGION");
  add_option(app, "--keep-upright", request.upright, msg::plan_option_upright, "ANGLE");
  add_option(app, "--keep-within", request.within, msg::plan_option_keep_within, "REGION");
  add_rule_options(app, request.rules);
}

bool is_given(const RobotRequest& request) {
  const std::string* const words[] = {
      &request.robot.robot, &request.robot.tip, &request.start, &request.goal,   &request.pos,
      &request.euler,       &request.quat,      &request.task,  &request.around, &request.lean,
      &request.turn,        &request.upright,   &request.within};
  return request.rules.any() || !request.goal_regions.empty() || !request.start_regions.empty() ||
         std::ranges::any_of(words, [](const std::string* word) { return !word->empty(); });
}

Result<int> plan_for_robot(const RobotRequest& request, const PlanOptions& options,
                           const std::optional<session::PlanShow>& show, AnswerOutput& output,
                           bool timing) {
  RobotChoice choice = request.robot;
  choice.looks = show.has_value();
  const Result<Robot> robot = load_robot(choice);
  if (!robot) return fail(robot.error());
  if (show && show->camera) {  // before a search of minutes
    const Result<render::Camera> camera = show->camera(robot->model);
    if (!camera) return fail(camera.error());
  }
  const Result<Way> way = read_way(request, *robot);
  if (!way) return fail(way.error());
  PlanOptions how = options;
  if (Result<void> read = read_limits(request, *robot, *way, how); !read) {
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
