#include <algorithm>
#include <cmath>

#include "mjarm/core/messages/reach.hpp"
#include "mjarm/rl/reach_env_internal.hpp"

// The state is: copies, observations a row, seed (high and low half); of every copy the number of
// its next episode, the steps done, three points, the final distance (-1 for none) and turn; the
// references of all joints; the worlds.
namespace mjarm::rl {
namespace {

constexpr std::size_t kHead = 4;
constexpr std::size_t kOfCopy = 13;

bool whole(double value, double max) {
  return value >= 0 && value <= max && value == std::floor(value);
}

}  // namespace

std::vector<double> ReachEnv::state() const {
  const Impl& env = *impl_;
  std::vector<double> state{1.0 * count(), 1.0 * env.size, static_cast<double>(env.seed >> 32),
                            static_cast<double>(env.seed & 0xffffffffU)};
  for (int i = 0; i < count(); ++i) {
    const Impl::Copy& copy = env.copies[i];
    state.insert(state.end(), {1.0 * copy.number, 1.0 * copy.steps});
    for (const Eigen::Vector3d& p : {copy.judged, copy.episode.goal, copy.episode.ball}) {
      state.insert(state.end(), p.begin(), p.end());
    }
    const double final_distance = env.final_distances[i];
    state.insert(state.end(),
                 {std::isnan(final_distance) ? -1 : final_distance, env.final_turns[i]});
  }
  state.insert(state.end(), env.references.begin(), env.references.end());
  const std::vector<double> worlds = env.batch.state();
  state.insert(state.end(), worlds.begin(), worlds.end());
  return state;
}

Result<void> ReachEnv::set_state(std::span<const double> state) {
  Impl& env = *impl_;
  const std::size_t n = env.copies.size();
  const std::size_t worlds_at = kHead + n * kOfCopy + env.references.size();
  const std::size_t wanted = this->state().size();
  if (state.size() != wanted || state[0] != static_cast<double>(n) || state[1] != env.size) {
    return fail(Errc::bad_input, text(msg::reach_other_state, state.size(), wanted));
  }
  bool fine = std::all_of(state.begin(), state.end(), [](double x) { return std::isfinite(x); }) &&
              whole(state[2], 0xffffffffU) && whole(state[3], 0xffffffffU);
  for (std::size_t i = 0; i < n && fine; ++i) {
    const double* of_copy = state.data() + kHead + i * kOfCopy;
    fine = whole(of_copy[0], 0xffffffffU) && whole(of_copy[1], env.options.episode_steps);
  }
  if (!fine) return fail(Errc::bad_input, text(msg::reach_bad_state));
  if (auto set = env.batch.set_state(state.subspan(worlds_at)); !set) return set;

  env.seed = (static_cast<std::uint64_t>(state[2]) << 32) | static_cast<std::uint64_t>(state[3]);
  for (std::size_t i = 0; i < n; ++i) {
    const double* at = state.data() + kHead + i * kOfCopy;
    Impl::Copy& copy = env.copies[i];
    copy.number = static_cast<std::uint32_t>(at[0]);
    copy.steps = static_cast<int>(at[1]);
    copy.judged = Eigen::Map<const Eigen::Vector3d>(at + 2);
    copy.episode.goal = Eigen::Map<const Eigen::Vector3d>(at + 5);
    copy.episode.ball = Eigen::Map<const Eigen::Vector3d>(at + 8);
    env.final_distances[i] = at[11] < 0 ? kNoDistance : at[11];
    env.final_turns[i] = at[12];
    env.distances[i] = (copy.judged - copy.episode.goal).norm();
  }
  std::copy_n(state.data() + kHead + n * kOfCopy, env.references.size(), env.references.begin());
  for (int i = 0; i < count(); ++i) env.observe(i);
  std::fill(env.rewards.begin(), env.rewards.end(), 0.0F);
  for (auto* flags : {&env.terminated, &env.truncated, &env.touching}) {
    std::fill(flags->begin(), flags->end(), std::uint8_t{0});
  }
  return {};
}

}  // namespace mjarm::rl
