#pragma once

#include <vector>

#include "apps/bench/ik_run.hpp"

namespace mjarm::app {

/// The suite's own columns.
[[nodiscard]] std::vector<Msg> ik_columns();

/// A judged run with its cells and, for the JSON document, every miss.
[[nodiscard]] BenchEntry ik_entry(const IkRun& run);

}  // namespace mjarm::app
