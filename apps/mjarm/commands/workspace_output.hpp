#pragma once

#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/kinematics/workspace.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::app {

/// What a map is written as.
enum class WorkspaceFormat { none, png, svg, csv, json };

/// The format that the ending of `path` names; `none` for an empty path, else a usage error.
[[nodiscard]] Result<WorkspaceFormat> workspace_format(const std::string& path);

/// A map and what it was made from.
struct WorkspaceReport {
  const Arm& arm;
  const WorkspaceOptions& work;
  const WorkspaceMap& map;
};

/// One line for people: how much is reached, how near to the base and how far.
[[nodiscard]] std::string workspace_summary(const WorkspaceReport& report);

/// The map as one JSON document: `null` stands for the manipulability of a cell out of reach.
[[nodiscard]] std::string workspace_json(const WorkspaceReport& report);

/// Writes the map to `path` in one step; nothing for `none`.
[[nodiscard]] Result<void> write_workspace(const WorkspaceReport& report, const std::string& path,
                                           WorkspaceFormat format);

}  // namespace mjarm::app
