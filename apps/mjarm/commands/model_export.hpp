#pragma once

#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm::app {

/// What `mjarm model export` was asked for, as the user wrote it.
struct ExportOptions {
  std::string to;   ///< format; empty = by the ending of `out`
  std::string out;  ///< file to write
  Replace replace = {};
};

/// Adds `--to FORMAT` and `--out FILE`, bound to `options`, and `--overwrite`.
void add_export_options(CLI::App& app, ExportOptions& options);

/// Writes `model` into the file in one step and tells what the format cannot say. Refuses to write
/// over the file that the model came from.
[[nodiscard]] Result<int> run_export(const Model& model, const ExportOptions& options);

}  // namespace mjarm::app
