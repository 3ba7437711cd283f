#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mjarm/control/controller.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// How long to measure. Every default is usable as is.
struct SimBenchOptions {
  int rounds = 40;  ///< every contestant once a round, > 0
  int steps = 250;  ///< simulation steps of one contestant in one round, > 0; short ones dodge
                    ///< what else the machine does
};

/// One way to step, timed.
struct SimBenchEntry {
  std::string name;  ///< "mj_step" (MuJoCo alone), a control mode, or "recorded"
  double us = 0;     ///< [us] wall clock a step, the fastest round
  double rtf = 0;    ///< simulated seconds a second of wall clock
  double ratio = 0;  ///< steps a second over those of mj_step; 1 = as fast
};

/// Times the followers' whole loop (controller, step, measuring; "recorded" also keeps every step)
/// against bare mj_step of the same model with the same commands. The contestants take turns in one
/// run, so that they share whatever else the machine does. The arm swings gently about `home`.
/// Modes that the arm's actuators cannot do are left out.
/// @return an error where no mode works or the simulation breaks down.
[[nodiscard]] Result<std::vector<SimBenchEntry>> bench_sim(const Model& model, const Arm& arm,
                                                           const SimBenchOptions& options = {});

}  // namespace mjarm
