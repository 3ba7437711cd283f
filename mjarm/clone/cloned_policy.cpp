#include "mjarm/clone/cloned_policy.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "mjarm/clone/observation.hpp"
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

/// Whether the policy is of the size of what is seen and done in this world.
Result<void> fits(const ClonedPolicy& cloned, const episode::TaskWorld& world) {
  const int wanted = observation_size(world.scene().objects.size());
  const rl::MixturePolicy& policy = cloned.policy;
  if (policy.net.shape().observations == wanted && policy.actions() == kActions) return {};
  return fail(Errc::bad_input, text(msg::clone_sizes, policy.net.shape().observations,
                                    policy.actions(), cloned.options.task, wanted, kActions));
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
  std::vector<episode::Verdict> out(static_cast<std::size_t>(scenes));
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;  // of what follows
  std::optional<Error> error;
  const auto keep = [&](Error what) {
    const std::scoped_lock lock(mutex);
    if (!error) error = std::move(what);
    next = out.size();
  };
  run_in_threads(threads, [&](int) {
    Result<episode::TaskWorld> world = episode::TaskWorld::open(cloned.options);
    if (!world) return keep(std::move(world.error()));
    if (auto fine = fits(cloned, *world); !fine) return keep(std::move(fine.error()));
    for (std::size_t i = next++; i < out.size(); i = next++) {
      auto verdict = try_policy(*world, kFirstTrial + i, cloned.policy, stop);
      if (!verdict) return keep(std::move(verdict.error()));
      const std::scoped_lock lock(mutex);
      out[i] = std::move(*verdict);
      if (after_one) after_one();
    }
  });
  if (error) return fail(std::move(*error));
  return out;
}

}  // namespace mjarm::clone
