#include "mjarm/kinematics/ik.hpp"

#include <cmath>
#include <memory>
#include <optional>

#include "apps/mjarm/cli/batch.hpp"
#include "apps/mjarm/cli/command.hpp"
#include "apps/mjarm/cli/options.hpp"
#include "apps/mjarm/cli/orientation.hpp"
#include "apps/mjarm/cli/robot.hpp"
#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/ik_answer.hpp"
#include "apps/mjarm/messages/app.hpp"
#include "mjarm/core/json.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/joint_values.hpp"

namespace mjarm::app {
namespace {

struct Options {
  RobotChoice robot{.looks = false};
  BatchOptions batch;
  std::string pos, euler, quat, seed_q, task = "pose", prefer, branch, seed = "1", threads = "1";
  bool all = false, windings = false, collisions = false, no_collisions = false, no_timing = false;
};

/// As pose_of(), but a position may stand alone where that is all that must be met.
Result<Pose> goal_of(const JsonValue& object, IkTask task) {
  if (task != IkTask::position || object.contains("quat")) return pose_of(object);
  const Result<std::vector<double>> pos = number_list(object, "pos", 3);
  if (!pos) return fail(pos.error());
  return Pose{{(*pos)[0], (*pos)[1], (*pos)[2]}, Eigen::Matrix3d::Identity()};
}

Result<IkRequest> read_request(std::string_view line, const IkSolver& ik) {
  const Arm& arm = ik.arm();
  const Result<JsonObject> object = parse_json_object(line);
  if (!object) return fail(object.error());
  constexpr std::string_view kKnown[] = {"pos", "quat", "seed"};
  if (Result<void> fine = check_keys(**object, kKnown); !fine) return fail(std::move(fine.error()));
  const Result<Pose> X_WT = goal_of(**object, ik.options().task);
  if (!X_WT) return fail(X_WT.error());
  if (!(*object)->contains("seed")) {
    return IkRequest{*X_WT, {arm.home.begin(), arm.home.end()}};
  }
  Result<std::vector<double>> q_seed =
      number_list(**object, "seed", static_cast<std::size_t>(arm.dof()));
  if (!q_seed) return fail(std::move(q_seed.error()));
  if (Result<void> fine = check_joint_units(*q_seed, arm); !fine) {
    return fail(in_option("seed", fine.error()));
  }
  return IkRequest{*X_WT, std::move(*q_seed), true};
}

Result<IkRequest> read_request(const Options& options, const IkSolver& ik) {
  const Arm& arm = ik.arm();
  const auto pos = parse_list("--pos", options.pos, Quantity::length, 3);
  if (!pos) return fail(pos.error());
  const bool any = ik.options().task == IkTask::position && (options.euler + options.quat).empty();
  const Result<Eigen::Matrix3d> R = any ? Result<Eigen::Matrix3d>(Eigen::Matrix3d::Identity())
                                        : parse_rotation(options.euler, options.quat);
  if (!R) return fail(R.error());
  IkRequest request{{{(*pos)[0], (*pos)[1], (*pos)[2]}, *R}, {arm.home.begin(), arm.home.end()}};
  if (options.seed_q.empty()) return request;
  Result<std::vector<double>> q_seed = parse_joints("--seed-q", options.seed_q, arm);
  if (!q_seed) return fail(std::move(q_seed.error()));
  request.q_seed = std::move(*q_seed);
  request.has_seed = true;
  return request;
}

Result<int> answer_one(IkDesk& desk, const Options& options) {
  const Result<IkRequest> request = read_request(options, desk.geometry());
  if (!request) return fail(request.error());
  std::string line;
  const std::optional<std::string> why = desk.answer(*request, line);
  return finish_one(options.batch, line, why, msg::app_ik_no_answer);
}

Result<int> answer_all(IkDesk& desk, const Options& options) {
  const auto answer_line = [&](std::string_view line,
                               std::string& out) -> Result<std::optional<std::string>> {
    const Result<IkRequest> request = read_request(line, desk.geometry());
    if (!request) return fail(request.error());
    return desk.answer(*request, out);
  };
  const auto done = run_batch(options.batch, text(msg::app_ik_progress), answer_line);
  if (!done) return fail(done.error());
  return finish_all(*done, msg::app_ik_some_failed);
}

/// Where to go with joints to spare; nowhere where nothing is asked for.
Result<std::optional<PostureGoal>> read_prefer(const Options& options) {
  constexpr PostureGoal kGoals[] = {PostureGoal::near_posture, PostureGoal::away_from_limits,
                                    PostureGoal::manipulability};
  if (options.prefer.empty()) return std::nullopt;
  if (options.all || options.windings) {
    const char* const all = options.all ? "--all" : "--windings";
    return fail(Errc::usage, text(msg::app_exclusive_options, "--prefer", all));
  }
  const auto choice = parse_choice("--prefer", options.prefer,
                                   std::vector<std::string>{"posture", "middle", "manipulability"});
  if (!choice) return fail(choice.error());
  return kGoals[*choice];
}

Result<Branch> read_branch(const std::string& words) {
  if (words.empty()) return Branch{};
  Result<Branch> branch = parse_branch(words);
  if (!branch) return fail(in_option("--branch", std::move(branch.error())));
  return branch;
}

Result<int> run(Options options) {
  if (Result<void> fine = one_source(options.batch.in, options.pos, "--pos"); !fine) {
    return fail(std::move(fine.error()));
  }
  const Result<std::uint64_t> seed = parse_whole("--seed", options.seed);
  if (!seed) return fail(seed.error());
  const Result<int> threads = parse_threads(options.threads);
  if (!threads) return fail(threads.error());
  options.batch.threads = *threads;
  const Result<IkTask> task = parse_task(options.task);
  if (!task) return fail(task.error());
  const auto prefer = read_prefer(options);
  if (!prefer) return fail(prefer.error());
  if (options.collisions && options.no_collisions) {
    return fail(Errc::usage, text(msg::app_exclusive_options, "--collisions", "--no-collisions"));
  }
  const Result<Branch> branch = read_branch(options.branch);
  if (!branch) return fail(branch.error());
  Result<Robot> robot = load_robot(options.robot);
  if (!robot) return fail(std::move(robot.error()));
  const bool single = options.batch.in.empty();
  IkDesk desk(*robot, {.ik = {.seed = *seed, .task = *task},
                       .contact = options.collisions || (single && !options.no_collisions),
                       .prefer = *prefer,
                       .branch = *branch,
                       .all = options.all || options.windings,
                       .windings = options.windings,
                       .timing = !options.no_timing,
                       .single = single});
  if (Result<void> fine = check_branch(desk.geometry(), *branch); !fine) {
    return fail(in_option("--branch", std::move(fine.error())));
  }
  return single ? answer_one(desk, options) : answer_all(desk, options);
}

Run setup(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_robot_options(app, options->robot);
  add_option(app, "--pos", options->pos, msg::app_option_pos, "X,Y,Z");
  add_option(app, "--euler", options->euler, msg::app_option_euler, "A,B,C");
  add_option(app, "--quat", options->quat, msg::app_option_quat, "W,X,Y,Z");
  add_option(app, "--seed-q", options->seed_q, msg::app_option_seed_q, "Q1,Q2,...");
  add_option(app, "--task", options->task, msg::app_option_task, "TASK");
  add_option(app, "--prefer", options->prefer, msg::app_option_prefer, "GOAL");
  add_option(app, "--branch", options->branch, msg::app_option_branch, "PART=WORD,...");
  add_flag(app, "--collisions", options->collisions, msg::app_ik_collisions);
  add_flag(app, "--no-collisions", options->no_collisions, msg::app_ik_no_collisions);
  add_batch_options(app, options->batch);
  add_option(app, "--seed", options->seed, msg::app_option_seed, "N");
  add_flag(app, "--all", options->all, msg::app_option_all);
  add_flag(app, "--windings", options->windings, msg::app_option_windings);
  add_option(app, "--threads", options->threads, msg::app_option_threads, "N");
  add_flag(app, "--no-timing", options->no_timing, msg::app_option_no_timing);
  return [options] { return run(*options); };
}

}  // namespace

Command ik_command() { return {"ik", msg::app_ik_summary, msg::app_ik_examples, setup}; }

}  // namespace mjarm::app
