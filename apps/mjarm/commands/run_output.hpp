#pragma once

#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/execution/report.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::app {

/// What a run leaves behind besides its log.
struct RunOutput {
  Report report;
  Plot plot;
  Overlay overlay;     ///< drawn into the picture
  std::string camera;  ///< of the model; empty = the model's own view
};

inline constexpr const char* kVideoFile = "video.mp4";

/// Writes report.json, plot.svg, plot.png and picture.png into `folder`. A machine without any GL
/// back end gets everything but the picture, and a line that says so.
[[nodiscard]] Result<void> write_output(const std::filesystem::path& folder, const Model& model,
                                        const Snapshot& snapshot, const RunOutput& output);

/// Says what came of a run and where its files are.
/// @return the exit code: 0, or 1 where the report is not ok.
[[nodiscard]] int conclude(const Report& report, const std::filesystem::path& out);

}  // namespace mjarm::app
