#pragma once

#include <filesystem>

#include "mjarm/core/result.hpp"
#include "mjarm/rl/policy.hpp"
#include "mjarm/rl/reach_options.hpp"

namespace mjarm::rl {

/// A policy and the task it was trained for.
struct TrainedPolicy {
  std::filesystem::path file;
  Policy policy;
  ReachOptions task;
};

/// Reads a checkpoint of `Training`, or a `.zip` of stable-baselines3, which knows no task: that of
/// the default options then.
/// @return bad_input that names the file where it is damaged or holds no policy.
[[nodiscard]] Result<TrainedPolicy> load_policy(const std::filesystem::path& file);

}  // namespace mjarm::rl
