#include "mjarm/clone/cloned_policy.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "mjarm/clone/trial.hpp"
#include "mjarm/core/messages/clone.hpp"
#include "mjarm/core/threads.hpp"
#include "mjarm/rl/safetensors.hpp"

namespace mjarm::clone {
namespace {

/// The whole number of an entry; 0 where it is none.
std::uint64_t whole(const std::string& word) {
  std::uint64_t out = 0;
  std::from_chars(word.data(), word.data() + word.size(), out);
  return out;
}

}  // namespace

Result<void> save_cloned(const std::filesystem::path& file, const ClonedPolicy& cloned) {
  rl::TensorSet set = cloned.policy.tensors();
  set.metadata["task"] = cloned.options.task;
  set.metadata["robot"] = cloned.options.robot;
  set.metadata["seed"] = std::to_string(cloned.options.seed);
  set.metadata["fps"] = std::to_string(cloned.options.fps);
  return rl::save_safetensors(file, set);
}

Result<ClonedPolicy> load_cloned(const std::filesystem::path& file) {
  const Result<rl::TensorSet> set = rl::load_safetensors(file);
  if (!set) return fail(set.error());
  const auto bad = [&](const std::string& why) {
    return fail(Errc::bad_input, text(msg::clone_no_policy, file.string(), why));
  };
  Result<rl::MixturePolicy> policy = rl::MixturePolicy::from(*set);
  if (!policy) return bad(policy.error().what);
  const auto entry = [&](const char* name) {
    const auto found = set->metadata.find(name);
    return found == set->metadata.end() ? std::string() : found->second;
  };
  ClonedPolicy out{.policy = std::move(*policy),
                   .options = {.task = entry("task"),
                               .robot = entry("robot"),
                               .seed = whole(entry("seed")),
                               .fps = static_cast<int>(std::min<std::uint64_t>(
                                   whole(entry("fps")), std::numeric_limits<int>::max()))}};
  if (auto fits = episode::check(out.options); !fits) return bad(fits.error().what);
  return out;
}

Result<std::vector<episode::Verdict>> try_often(const ClonedPolicy& cloned, int scenes, int threads,
                                                const StopCheck& stop,
                                                const std::function<void()>& after_one) {
  const Result<episode::Studio> studio = episode::Studio::open(cloned.options);
  if (!studio) return fail(studio.error());
  const Robot& robot = studio->robot();
  const Result<Jaws> jaws = find_jaws(robot.model, robot.arm);
  if (!jaws) return fail(jaws.error());
  const episode::DrawnScene first = episode::draw_scene(robot, cloned.options, kFirstTrial);
  const int wanted = observation_size(first.objects.size());
  if (cloned.policy.net.shape().observations != wanted || cloned.policy.actions() != kActions) {
    return fail(Errc::bad_input,
                text(msg::clone_sizes, cloned.policy.net.shape().observations,
                     cloned.policy.actions(), cloned.options.task, wanted, kActions));
  }
  std::vector<episode::Verdict> out(static_cast<std::size_t>(scenes));
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;  // of what follows
  std::optional<Error> error;
  run_in_threads(threads, [&](int) {
    for (std::size_t i = next++; i < out.size(); i = next++) {
      const episode::DrawnScene scene = episode::draw_scene(robot, cloned.options, kFirstTrial + i);
      auto verdict = try_policy(robot, *jaws, cloned.policy, cloned.options, scene, stop);
      const std::scoped_lock lock(mutex);
      if (!verdict && !error) error = std::move(verdict.error());
      if (error) return;
      out[i] = std::move(*verdict);
      if (after_one) after_one();
    }
  });
  if (error) return fail(std::move(*error));
  return out;
}

}  // namespace mjarm::clone
