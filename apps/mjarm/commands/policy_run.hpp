#pragma once

#include <cstdint>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/rl/evaluate.hpp"
#include "mjarm/rl/trained_policy.hpp"
#include "mjarm/session/stage.hpp"

namespace mjarm::app {

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
[[nodiscard]] Result<PolicyOutcome> run_policy(const rl::TrainedPolicy& loaded,
                                               const PolicyTrial& trial,
                                               const session::StageOptions& options);

}  // namespace mjarm::app
