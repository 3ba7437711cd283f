#pragma once

#include <span>
#include <vector>

#include "apps/bench/time_run.hpp"

namespace mjarm::app {

/// The suite's own columns.
[[nodiscard]] std::vector<Msg> time_columns();

/// A run with its cells and, for the JSON document, every case that is not right.
/// @param best  [s] durations to compare with, one a case; empty where there are none.
[[nodiscard]] BenchEntry time_entry(const TimeSet& set, const TimeRun& run,
                                    std::span<const double> best);

/// How many cases have no motion, pass a limit or do not arrive.
[[nodiscard]] int wrong_motions(const TimeRun& run);

}  // namespace mjarm::app
