#pragma once

#include <optional>
#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/session/show_plan.hpp"

namespace mjarm::app {

/// What is asked to be shown of a plan, as it stands on the command line.
struct PlanShowArguments {
  std::string picture, html, size, camera, quality, seconds;
  bool view = false;
  /// Whether anything is.
  [[nodiscard]] bool wanted() const { return view || !picture.empty() || !html.empty(); }
};

/// Adds `--picture`, `--html`, `--view`, `--size`, `--camera`, `--quality` and `--seconds`, bound
/// to `arguments`.
void add_plan_show_options(CLI::App& app, PlanShowArguments& arguments);

/// Reads the options. @return none where nothing is to be shown; a usage error that names the one
/// that is wrong.
[[nodiscard]] Result<std::optional<session::PlanShow>> read_plan_show(
    const PlanShowArguments& arguments);

}  // namespace mjarm::app
