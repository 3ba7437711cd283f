#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/episode/options.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/rl/mixture_policy.hpp"

namespace mjarm::clone {

/// A policy and what it was cloned for.
struct ClonedPolicy {
  rl::MixturePolicy policy;
  episode::EpisodeOptions options;  ///< of the episodes; those of pictures mean nothing here
};

/// Writes it in one step, as tensors (see MixturePolicy::tensors()) with the task in the metadata.
[[nodiscard]] Result<void> save_cloned(const std::filesystem::path& file,
                                       const ClonedPolicy& cloned);
/// @return bad_input that names the file where it is damaged or holds no cloned policy.
[[nodiscard]] Result<ClonedPolicy> load_cloned(const std::filesystem::path& file);

/// The first number of the scenes that policies are tried in: no episode of `mjarm record` has so
/// high a one, so none was demonstrated.
inline constexpr std::uint64_t kFirstTrial = 1'000'000;

/// Tries a policy in scenes kFirstTrial and on, in several threads, whose number changes nothing.
/// @param after_one  called after each, from one thread at a time; may be empty.
/// @return how each went, in order; bad_input for a policy of another size; errors as try_policy()
///         and TaskWorld::open() have them.
[[nodiscard]] Result<std::vector<episode::Verdict>> try_often(
    const ClonedPolicy& cloned, int scenes, int threads, const StopCheck& stop = {},
    const std::function<void()>& after_one = {});

}  // namespace mjarm::clone
