#pragma once

#include <filesystem>

#include "mjarm/execution/report.hpp"

namespace mjarm::app {

/// Says what came of a run and where its files are.
/// @return the exit code: 0, or 1 where the report is not ok.
[[nodiscard]] int conclude(const Report& report, const std::filesystem::path& out);

}  // namespace mjarm::app
