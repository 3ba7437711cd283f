#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/mjarm/commands/stage.hpp"
#include "apps/mjarm/commands/train_task.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/rl/policy.hpp"

namespace mjarm::app {

/// A policy and the task it was trained for.
struct LoadedPolicy {
  std::filesystem::path file;
  rl::Policy policy;
  rl::ReachOptions task;
};

/// Reads one of ours, or a `.zip` of stable-baselines3, which knows no task: the defaults then.
[[nodiscard]] Result<LoadedPolicy> load_policy(const std::filesystem::path& file);

/// How a policy is tried.
struct PolicyTrial {
  std::string name;          ///< of the report
  int episodes = 200;        ///< that count, on goals never trained on
  std::uint64_t seed = 1;    ///< of the goals
  int shown = 6;             ///< first goals that are shown, filmed and logged
  double least_success = 0;  ///< share within 2 cm below which the report is not ok
};

/// What came of it.
struct PolicyOutcome {
  Report report;
  rl::Evaluation evaluation;
};

/// Tries a policy on unseen goals, shows some of them, and writes report.json, log.csv, plot and
/// picture into `options.out`.
[[nodiscard]] Result<PolicyOutcome> run_policy(const LoadedPolicy& loaded, const PolicyTrial& trial,
                                               const StageOptions& options);

}  // namespace mjarm::app
