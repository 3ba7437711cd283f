#include "mjarm/rl/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "mjarm/core/messages/reach.hpp"
#include "mjarm/rl/reach_env.hpp"

namespace mjarm::rl {
namespace {

constexpr double kNear = 0.02;  // [m] of steps_to_2cm
constexpr double kLost = std::numeric_limits<double>::infinity();

/// The first episode of every copy, as it goes on.
struct Trial {
  bool over = false;
  int steps = 0;
  int steps_to_near = 0;  ///< 0: not yet
  bool touched = false;
  double distance = kLost;
  double turn = 0;
};

/// Takes note of the step just done; returns how many trials ended in it.
int follow(const ReachEnv& env, std::vector<Trial>& trials) {
  int ended = 0;
  for (int i = 0; i < env.count(); ++i) {
    Trial& trial = trials[i];
    if (trial.over) continue;
    ++trial.steps;
    trial.touched = trial.touched || env.touching()[i] != 0;
    if (trial.steps_to_near == 0 && env.distances()[i] < kNear) trial.steps_to_near = trial.steps;
    if (env.terminated()[i] == 0 && env.truncated()[i] == 0) continue;
    trial.over = true;
    ++ended;
    const double distance = env.final_distances()[i];
    if (!std::isnan(distance)) trial.distance = distance;
    trial.turn = env.final_turns()[i];
  }
  return ended;
}

/// The smallest of `sorted` that so large a share of them does not exceed.
double quantile(const std::vector<double>& sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double share_within(const std::vector<double>& sorted, double distance) {
  const auto end = std::upper_bound(sorted.begin(), sorted.end(), distance);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

Evaluation summary(const std::vector<Trial>& trials) {
  Evaluation e;
  e.episodes = static_cast<int>(trials.size());
  std::vector<double> turns;
  int near_ones = 0;
  for (const Trial& trial : trials) {
    e.distances.push_back(trial.distance);
    turns.push_back(trial.turn);
    e.steps += trial.steps;
    e.touched += trial.touched ? 1 : 0;
    e.steps_to_2cm += trial.steps_to_near;
    near_ones += trial.steps_to_near > 0 ? 1 : 0;
  }
  e.steps /= e.episodes;
  e.touched /= e.episodes;
  e.steps_to_2cm /= std::max(near_ones, 1);
  std::vector<double> sorted = e.distances;
  std::sort(sorted.begin(), sorted.end());
  std::sort(turns.begin(), turns.end());
  e.within_5cm = share_within(sorted, 0.05);
  e.within_2cm = share_within(sorted, 0.02);
  e.within_1cm = share_within(sorted, 0.01);
  e.within_5mm = share_within(sorted, 0.005);
  e.median = quantile(sorted, 0.5);
  e.p95 = quantile(sorted, 0.95);
  e.max = sorted.back();
  e.turn_median = quantile(turns, 0.5);
  e.turn_p95 = quantile(turns, 0.95);
  return e;
}

constexpr int kTogether = 1024;  // episodes that are run at the same time

/// Runs episodes `first` to `end`, and adds what came of them to `trials`.
Result<void> run_block(ReachEnv& env, int first, const ActFunction& act, const EvaluateOptions& how,
                       std::vector<Trial>& trials) {
  if (auto begun = env.reset(how.seed, first); !begun) return begun;
  const std::int64_t length = env.options().episode_steps;
  std::vector<Trial> block(env.count());
  std::vector<float> actions(static_cast<std::size_t>(env.count()) * env.action_size());
  std::int64_t step = 0;
  for (int left = env.count(); left > 0; left -= follow(env, block), ++step) {
    if (is_stopped(how.stop)) return fail(stopped());
    if (how.progress) {
      how.progress(first * length + step * env.count(), how.episodes * length);
    }
    act(env.observations(), actions);
    if (auto stepped = env.step(actions, how.stop); !stepped) return stepped;
  }
  trials.insert(trials.end(), block.begin(), block.end());
  return {};
}

/// Every episode, some at a time: each draws from a stream of its own, and comes out the same.
/// @param fits  asked about the environment first.
Result<Evaluation> run(const Model& model, ReachOptions options, const ActFunction& act,
                       const EvaluateOptions& how,
                       const std::function<Result<void>(const VecEnv&)>& fits) {
  constexpr int kMaxEpisodes = 100'000;
  options.held_out = true;
  std::vector<Trial> trials;
  std::optional<ReachEnv> env;
  for (int first = 0; first == 0 || first < how.episodes; first += kTogether) {
    const bool sound = how.episodes >= 1 && how.episodes <= kMaxEpisodes;
    // A number out of range is told of by the environment.
    const int count = sound ? std::min(kTogether, how.episodes - first) : how.episodes;
    if (!env || env->count() != count) {
      options.environments = count;
      Result<ReachEnv> made = ReachEnv::create(model, options);
      if (!made) return fail(std::move(made.error()));
      env.emplace(std::move(*made));
    }
    if (auto fine = fits(*env); !fine) return fail(std::move(fine.error()));
    if (auto done = run_block(*env, first, act, how, trials); !done)
      return fail(std::move(done.error()));
  }
  return summary(trials);
}

}  // namespace

Result<void> check_sizes(const Policy& policy, const VecEnv& env) {
  const int in = env.observation_size(), out = env.action_size();
  const PolicyShape& shape = policy.shape();
  if (shape.observations == in && shape.actions == out) return {};
  return fail(Errc::bad_input,
              text(msg::reach_policy_size, shape.observations, shape.actions, in, out));
}

Result<Evaluation> evaluate(const Model& model, const ReachOptions& options, const ActFunction& act,
                            const EvaluateOptions& how) {
  return run(model, options, act, how, [](const VecEnv&) { return Result<void>(); });
}

Result<Evaluation> evaluate(const Model& model, const ReachOptions& options, const Policy& policy,
                            const EvaluateOptions& how) {
  const std::size_t in = policy.shape().observations, out = policy.shape().actions;
  const auto act = [&](std::span<const float> observations, std::span<float> actions) {
    for (std::size_t i = 0; i * out < actions.size() && !is_stopped(how.stop); ++i) {
      const Eigen::VectorXf action = policy.act(observations.subspan(i * in, in));
      std::copy_n(action.data(), out, actions.begin() + static_cast<std::ptrdiff_t>(i * out));
    }
  };
  return run(model, options, act, how, [&](const VecEnv& env) { return check_sizes(policy, env); });
}

}  // namespace mjarm::rl
