#pragma once

#include <string>
#include <vector>

#include "mjarm/execution/report.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/rl/evaluate.hpp"

namespace mjarm::app {

/// `within 5 cm 100.0 %, 2 cm 97.5 %, 1 cm 81.0 %, 5 mm 42.0 %; median 5.9 mm`, for people.
[[nodiscard]] std::string in_words(const rl::Evaluation& evaluation);

/// Number of goals missed by 2 cm or more.
[[nodiscard]] int missed_of(const rl::Evaluation& evaluation);

/// A table of shares, distances and steps, for people.
[[nodiscard]] std::string evaluation_table(const rl::Evaluation& evaluation);

/// What report.json says of it: `success` (share within 2 cm), `within`, distances and steps.
[[nodiscard]] std::vector<Fact> facts_of(const rl::Evaluation& evaluation);

/// Which share of the goals is reached within which distance, from 1 mm to 20 cm.
[[nodiscard]] render::PlotPanel distance_panel(const rl::Evaluation& evaluation);

}  // namespace mjarm::app
