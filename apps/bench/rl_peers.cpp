#include <algorithm>
#include <utility>

#include "apps/bench/peers.hpp"
#include "apps/bench/rl.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {
namespace {

using Rows = std::vector<std::vector<double>>;

constexpr double kTolerance = 1e-4;  // of observations and rewards of a peer's environment

std::vector<double> values_of(const Eigen::VectorXd& v) { return {v.begin(), v.end()}; }

Result<rl::ReachEnv> env_of(const Model& model, rl::ReachOptions options, int copies) {
  options.environments = copies;
  return rl::ReachEnv::create(model, options);
}

/// Goals of at least `count` episodes as they are drawn for training.
Result<Rows> goals_of(const Model& model, const LearningSet& set, std::uint64_t seed) {
  constexpr int kCopies = 64;
  const auto& options = set.options;
  const std::int64_t count = options.ppo.total_steps / options.task.episode_steps +
                             std::int64_t{2} * options.task.environments;
  auto env = env_of(model, options.task, kCopies);
  if (!env) return fail(std::move(env.error()));
  Rows goals;
  for (std::uint64_t draw = 0; static_cast<std::int64_t>(goals.size()) < count; ++draw) {
    if (auto begun = env->reset((seed << 32) + draw); !begun) return fail(begun.error());
    for (int i = 0; i < kCopies; ++i) goals.push_back(values_of(env->goal(i)));
  }
  return goals;
}

/// Those on which ours is judged.
Result<Rows> unseen_goals(const Model& model, const LearningSet& set) {
  rl::ReachOptions options = set.options.task;
  options.held_out = true;
  auto env = env_of(model, options, set.options.evaluation.episodes);
  if (!env) return fail(std::move(env.error()));
  if (auto begun = env->reset(set.options.evaluation.seed); !begun) return fail(begun.error());
  Rows goals;
  for (int i = 0; i < env->count(); ++i) goals.push_back(values_of(env->goal(i)));
  return goals;
}

/// An episode of random actions: what was seen before each of them, and the reward after it.
/// @param env  one copy, at the start of an episode.
Result<JsonDoc> trace_of(rl::ReachEnv& env) {
  const std::vector<double> goal = values_of(env.goal(0));
  Rows actions, observations;
  std::vector<double> rewards;
  Rng rng(0);
  for (int step = 0; step < env.options().episode_steps; ++step) {
    std::vector<float> action(env.action_size());
    for (float& value : action) value = static_cast<float>(rng.uniform(-1, 1));
    observations.emplace_back(env.observations().begin(), env.observations().end());
    actions.emplace_back(action.begin(), action.end());
    if (auto stepped = env.step(action); !stepped) return fail(stepped.error());
    rewards.push_back(env.rewards()[0]);
  }
  return JsonDoc{
      {"goal", goal}, {"actions", actions}, {"observations", observations}, {"rewards", rewards}};
}

JsonDoc reward_json(const rl::ReachReward& r) {
  return {
      {"distance", r.distance},   {"coarse", r.coarse},         {"coarse_scale", r.coarse_scale},
      {"fine", r.fine},           {"fine_scale", r.fine_scale}, {"action", r.action},
      {"collision", r.collision}, {"limit", r.limit},           {"limit_margin", r.limit_margin}};
}

/// Everything of the task but its goals.
/// @param env  at the start of an episode.
Result<JsonDoc> task_json(const rl::ReachEnv& env) {
  const rl::ReachOptions& options = env.options();
  const Arm& arm = env.arm();
  Sim start(env.model());
  if (auto restored = start.restore(env.snapshot(0)); !restored) return fail(restored.error());
  std::vector<std::string> joints, actuators;
  for (const ArmJoint& joint : arm.joints) {
    joints.push_back(joint.name);
    actuators.push_back(joint.actuator->name);
  }
  const auto values = [](std::span<const double> v) {
    return std::vector<double>(v.begin(), v.end());
  };
  return JsonDoc{
      {"model", env.model().file().string()},
      {"tool", arm.tip},
      {"joints", joints},
      {"actuators", actuators},
      {"fingers", arm.gripper ? arm.gripper->joints : std::vector<std::string>()},
      {"qpos", values(start.qpos())},
      {"ctrl", values(start.ctrl())},
      {"lower", arm.limits.lower},
      {"upper", arm.limits.upper},
      {"speed", JointVec(options.speed * arm.limits.velocity)},
      {"frame_skip", options.frame_skip},
      {"episode_steps", options.episode_steps},
      {"reward", reward_json(options.reward)},
  };
}

JsonDoc ppo_json(const rl::TrainingOptions& options) {
  const rl::PpoOptions& ppo = options.ppo;
  const auto layers = [](const std::vector<int>& sizes) {
    return std::vector<JsonDoc>(sizes.begin(), sizes.end());
  };
  return {{"environments", options.task.environments},
          {"total_steps", static_cast<std::size_t>(ppo.total_steps)},
          {"rollout_steps", ppo.rollout_steps},
          {"minibatch", ppo.minibatch},
          {"epochs", ppo.epochs},
          {"learning_rate", ppo.learning_rate},
          {"discount", ppo.discount},
          {"gae_lambda", ppo.gae_lambda},
          {"clip", ppo.clip},
          {"value_weight", ppo.value_weight},
          {"entropy_weight", ppo.entropy_weight},
          {"max_gradient_norm", ppo.max_gradient_norm},
          {"actor", layers(ppo.actor)},
          {"critic", layers(ppo.critic)},
          {"initial_log_std", ppo.initial_log_std}};
}

Result<JsonDoc> job_of(const Model& model, const LearningSet& set, std::uint64_t seed) {
  constexpr double kSecondsAStep = 0.005;  // many times what peers take
  const Result<Rows> goals = goals_of(model, set, seed);
  if (!goals) return fail(goals.error());
  const Result<Rows> unseen = unseen_goals(model, set);
  if (!unseen) return fail(unseen.error());
  auto env = env_of(model, set.options.task, 1);
  if (!env) return fail(std::move(env.error()));
  Result<JsonDoc> task = task_json(*env);
  if (!task) return task;
  Result<JsonDoc> trace = trace_of(*env);
  if (!trace) return trace;
  const rl::TrainingOptions& options = set.options;
  return JsonDoc{{"set", set.name},
                 {"seed", static_cast<std::size_t>(seed)},
                 {"threads", options.ppo.threads},
                 {"seconds", 300 + kSecondsAStep * static_cast<double>(options.ppo.total_steps)},
                 {"evaluate_every", static_cast<std::size_t>(options.evaluate_every)},
                 {"tolerance", kTolerance},
                 {"task", std::move(*task)},
                 {"ppo", ppo_json(options)},
                 {"trace", std::move(*trace)},
                 {"unseen", *unseen},
                 {"goals", *goals}};
}

/// The curve of one answer; throws `BrokenAnswer`.
std::vector<LearningPoint> curve_in(const JsonValue& line, std::size_t goals) {
  std::vector<LearningPoint> curve;
  for (const JsonValue& point : list_in(line, "curve")) {
    LearningPoint& taken = curve.emplace_back();
    taken.steps = static_cast<std::int64_t>(number_in(point, "steps"));
    taken.seconds = number_in(point, "seconds");
    taken.distances = numbers_in(point, "distances");
    if (taken.distances.size() != goals) broken("distances");
  }
  return curve;
}

}  // namespace

Result<std::vector<LearningRun>> run_learning_peers(const Model& model, const LearningSet& set,
                                                    std::uint64_t seed,
                                                    const std::filesystem::path& environment) {
  Result<JsonDoc> job = job_of(model, set, seed);
  if (!job) return fail(std::move(job.error()));
  auto runs = peer_runs<LearningRun>(
      environment, "reaching", std::move(*job), [&](const JsonValue& line, LearningRun& run) {
        run.curve = curve_in(line, static_cast<std::size_t>(set.options.evaluation.episodes));
      });
  if (!runs) return runs;
  for (LearningRun& run : *runs) {
    run.seed = seed;
    run.set = set.name;
  }
  return runs;
}

}  // namespace mjarm::app
