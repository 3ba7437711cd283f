#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/core/stop.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/teleop/input_file.hpp"
#include "mjarm/teleop/teleop.hpp"

namespace mjarm::session {

/// How recorded inputs are played. Every default is usable as is.
struct TeleopRunOptions {
  TeleopOptions teleop = {};
  std::filesystem::path out = {};  ///< folder of log.csv and report.json; empty: none are written
  std::string robot = {};          ///< as the user named it, for the episode
  std::string task = {};           ///< in words: the run becomes an episode in `out`; empty: not
  int fps = 20;                    ///< [1/s] rows of that
  bool timing = true;              ///< wall-clock fields in the report
  Replace replace = {};
  StopCheck stop = {};
};

/// What came of it.
struct TeleopRunReport {
  double duration = 0;                ///< [s] simulated
  double way = 0;                     ///< [m] of the tool
  double slowed = 0;                  ///< [s] something was near, and made it slower
  bool stopped = false;               ///< before the end
  std::optional<NearBodies> nearest;  ///< of all that was within 0.1 m
  /// What the arm touched first that it should not: "link1 - table at 1.25 s"; empty: nothing. By
  /// MuJoCo's contacts; fingers may touch bodies with a free joint.
  std::string touched = {};
  double rtf = 0;  ///< simulated seconds a wall-clock second

  [[nodiscard]] bool ok() const { return touched.empty() && !stopped; }
  /// `report.json`.
  [[nodiscard]] JsonDoc json(bool timing) const;
};

/// Leads the robot from its home by `inputs`, until the time of the last of them, and writes what
/// became of it. The same inputs give the same files.
/// @return an error where it cannot begin, the simulation broke down or a file cannot be written.
[[nodiscard]] Result<TeleopRunReport> play_inputs(const Robot& robot,
                                                  std::span<const TimedInput> inputs,
                                                  const TeleopRunOptions& options);

}  // namespace mjarm::session
