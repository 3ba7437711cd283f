#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mjarm/core/long_result.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/render/plot.hpp"
#include "mjarm/session/run_model.hpp"
#include "mjarm/sim/state_log.hpp"

namespace mjarm::session {

/// Where the files of a simulated model go, and which.
struct ModelOutput {
  std::filesystem::path out;  ///< folder
  render::Camera camera = {};
  bool video = false;  ///< video.mp4 as well
  bool timing = true;  ///< wall-clock fields in the report
  Replace replace = {};
};

/// What came of it.
struct ModelRunReport {
  bool ok = false;
  std::string reason = {};  ///< where not ok: `unstable`, `stopped`
  std::string detail = {};  ///< one line for people where not ok
  double duration = 0;      ///< [s] simulated
  long steps = 0;
  std::vector<double> qpos_start, qpos_end;  ///< (nq,)
  std::optional<double> rtf = {};            ///< simulated seconds a wall-clock second
};

/// Simulates a model and writes log.csv, plot.svg and .png, picture.png of the end, report.json
/// and, if asked for, video.mp4. A run that becomes unstable or is stopped leaves all of them
/// (but for the video of one that was stopped) with what there was until then.
/// @return an error where it cannot begin or a file cannot be written.
[[nodiscard]] Result<ModelRunReport> simulate_model(const Model& model,
                                                    const ModelRunOptions& options,
                                                    const ModelOutput& output);

/// Angles, lengths, commands and sensors over time, those that the model has; of each at most eight
/// curves, those that move most.
[[nodiscard]] render::Plot state_plot(const std::string& title, const StateLog& log);

}  // namespace mjarm::session
